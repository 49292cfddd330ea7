from __future__ import annotations

import numpy as np
import pytest
from optuna.trial import FixedTrial
from xgboost import XGBRegressor

from softkin.models.xgboost import SPEC, build
from tests.conftest import bending_arm


def test_the_papers_settings_are_xgboosts_own_and_so_is_the_first_trial_without_a_trend() -> None:
    rows = bending_arm(80)
    expected = XGBRegressor(n_jobs=1, random_state=0).fit(rows.commands, rows.positions).predict(rows.commands)
    first = SPEC.search_space(FixedTrial(dict(SPEC.first_trials[0])))
    assert first["trend"] == "none"
    for params in ({**SPEC.paper_params}, first):
        fitted = build(params, 0, 1).fit(rows.commands, rows.positions)
        np.testing.assert_array_equal(fitted.predict(rows.commands), expected)


def test_one_tree_per_coordinate_and_round() -> None:
    rows = bending_arm(60)
    fitted = build({"n_estimators": 7, "max_depth": 2}, 0, 1).fit(rows.commands, rows.positions)
    assert len(fitted.get_booster().get_dump()) == 7 * 3


@pytest.mark.parametrize("trend", ["linear", "quadratic"])
def test_a_trend_continues_where_trees_end_at_a_constant(trend: str) -> None:
    commands = np.random.default_rng(0).uniform(-1, 1, (100, 1))
    targets = np.column_stack([commands[:, 0], -2 * commands[:, 0]])
    far = np.array([[3.0], [4.0]])
    continued = build({"n_estimators": 20, "trend": trend}, 0, 1).fit(commands, targets).predict(far)
    np.testing.assert_allclose(continued, [[3.0, -6.0], [4.0, -8.0]], atol=1e-6)
    plain = build({"n_estimators": 20}, 0, 1).fit(commands, targets).predict(far)
    np.testing.assert_array_equal(plain[0], plain[1])


def test_it_takes_the_threads_it_is_allowed() -> None:
    assert build({}, 0, 2).n_jobs == 2
