from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.export.c_text import Tables, identifier, number


def test_numbers_read_back_the_same() -> None:
    assert [number(value) for value in (0.1, -np.inf, 1e-300)] == ["0.1", "-HUGE_VAL", "1e-300"]


@pytest.mark.parametrize(("name", "plain"), [("finger", "finger"), ("7 arms", "robot_7_arms"), ("ärm", "robot__rm")])
def test_names_are_identifiers(name: str, plain: str) -> None:
    assert identifier(name) == plain


def test_tables_are_of_doubles_or_of_whole_numbers() -> None:
    tables = Tables("arm")
    assert [tables.name(np.array([1.0, 2.5])), tables.name([1, 2]), tables.name(np.array([[1.0], [2.5]]))] == [
        "arm_t0",
        "arm_t1",
        "arm_t0",
    ]
    assert tables.texts == [
        "static const double arm_t0[2] = {\n    1.0, 2.5};",
        "static const int arm_t1[2] = {\n    1, 2};",
    ]
