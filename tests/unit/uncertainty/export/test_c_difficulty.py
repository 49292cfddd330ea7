from __future__ import annotations

import numpy as np

from softkin.uncertainty.export.c_difficulty import FACTORS, difficulty_text
from softkin.uncertainty.export.c_text import Tables
from softkin.uncertainty.export.numbers import exported_numbers
from tests.exported_robots import hard_somewhere, small


def test_every_kind_of_difficulty_is_written_and_none_where_there_is_none() -> None:
    kinds = set()
    for robot in (*map(small, ("lr", "lasso", "gp")), hard_somewhere()):
        numbers = exported_numbers(robot, most=10**7)
        kind, text = numbers["difficulty"]["kind"], difficulty_text(numbers, Tables("arm"))
        assert bool(text) == (kind != "none")
        kinds.add(kind)
    assert kinds == set(FACTORS)


def test_columns_of_errors_without_a_share_are_left_out() -> None:
    numbers = exported_numbers(hard_somewhere(), most=10**6)
    node = numbers["difficulty"]
    assert 0 < np.count_nonzero(node["shares"]) <= 3
    assert difficulty_text(numbers, Tables("arm")).count("softkin_near(") == np.count_nonzero(node["shares"])
