from __future__ import annotations

import numpy as np
import pytest
from optuna.trial import FixedTrial
from sklearn.ensemble import GradientBoostingRegressor, HistGradientBoostingRegressor

from softkin.core.samples import Params
from softkin.models.gradient_boosting import SPEC
from tests.conftest import bending_arm


def test_the_papers_settings_are_scikit_learns_one_ensemble_per_coordinate() -> None:
    rows = bending_arm(60)
    fitted = SPEC.build({**SPEC.paper_params}, 3, 1).fit(rows.commands, rows.positions)
    for coordinate, ensemble in enumerate(fitted.estimators_):
        expected = GradientBoostingRegressor(random_state=3).fit(rows.commands, rows.positions[:, coordinate])
        np.testing.assert_array_equal(ensemble.predict(rows.commands), expected.predict(rows.commands))
    assert len(fitted.estimators_) == 3


def test_a_searched_one_is_a_histograms_and_the_papers_is_not() -> None:
    rows = bending_arm(60)
    for params in (SPEC.search_space(FixedTrial(dict(first))) for first in SPEC.first_trials):
        fitted = SPEC.build({**params, "trend": "none"}, 0, 1).fit(rows.commands, rows.positions)
        assert all(isinstance(each, HistGradientBoostingRegressor) for each in fitted.estimators_)
        assert all(each.n_iter_ == params["max_iter"] for each in fitted.estimators_)
    assert "tree_method" not in SPEC.paper_params


@pytest.mark.parametrize("trend", ["linear", "quadratic"])
def test_a_trend_continues_where_trees_end_at_a_constant(trend: str) -> None:
    commands = np.random.default_rng(0).uniform(-1, 1, (100, 1))
    targets = np.column_stack([commands[:, 0], -2 * commands[:, 0]])
    params = {"n_estimators": 20, "trend": trend}
    far = SPEC.build(params, 0, 1).fit(commands, targets).predict(np.array([[3.0], [4.0]]))
    np.testing.assert_allclose(far, [[3.0, -6.0], [4.0, -8.0]], atol=1e-9)
    plain = SPEC.build({"n_estimators": 20}, 0, 1).fit(commands, targets).predict(np.array([[3.0], [4.0]]))
    np.testing.assert_array_equal(plain[0], plain[1])


@pytest.mark.parametrize(
    "params",
    [{"n_estimators": 10, "subsample": 0.5}, {"tree_method": "hist", "max_iter": 10, "max_features": 0.5}],
)
def test_the_seed_decides_which_rows_or_commands_a_tree_sees(params: Params) -> None:
    rows = bending_arm(60)
    one, same, other = (
        SPEC.build(params, seed, 1).fit(rows.commands, rows.positions).predict(rows.commands) for seed in (0, 0, 1)
    )
    np.testing.assert_array_equal(one, same)
    assert not np.allclose(one, other)
