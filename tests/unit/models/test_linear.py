from __future__ import annotations

import numpy as np
import pytest
from sklearn.linear_model import LinearRegression

from softkin.core.samples import Array, Params
from softkin.models.linear import SPEC
from tests.conftest import bending_arm

COMMANDS = np.random.default_rng(0).uniform(-1, 1, (60, 2))


def predicted(params: Params, targets: Array) -> Array:
    return np.asarray(SPEC.build(params, 0, 1).fit(COMMANDS, targets).predict(COMMANDS))


def test_the_papers_settings_are_ordinary_least_squares_on_the_commands() -> None:
    rows = bending_arm(60)
    fitted = SPEC.build({**SPEC.paper_params}, 0, 1).fit(rows.commands, rows.positions)
    expected = LinearRegression().fit(rows.commands, rows.positions).predict(rows.commands)
    np.testing.assert_allclose(fitted.predict(rows.commands), expected, atol=1e-10)


@pytest.mark.parametrize("degree", [1, 2, 3, 6])
def test_a_polynomial_of_its_degree_is_recovered_and_none_beyond(degree: int) -> None:
    first, second = COMMANDS.T
    recovered, too_high = first**degree - second, first ** (degree + 1)
    targets = np.column_stack([recovered, too_high])
    errors = np.abs(predicted({"degree": degree}, targets) - targets).max(axis=0)
    assert errors[0] < 1e-9
    assert errors[1] > 1e-4


def test_interactions_alone_leave_out_pure_powers() -> None:
    first, second = COMMANDS.T
    targets = np.column_stack([first * second, first**2])
    errors = np.abs(predicted({"degree": 2, "interaction_only": True}, targets) - targets).max(axis=0)
    assert errors[0] < 1e-9
    assert errors[1] > 0.1
