from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.models.random_forest import SPEC, build
from tests.conftest import bending_arm

FEW = {"n_estimators": 20}


def test_a_forest_stays_within_the_positions_it_is_fitted_on_and_a_trend_continues() -> None:
    rows = bending_arm(100)
    far = 3 * rows.commands
    low, high = rows.positions.min(axis=0), rows.positions.max(axis=0)
    plain = build(FEW, 0, 1).fit(rows.commands, rows.positions).predict(far)
    assert (plain >= low - 1e-9).all()
    assert (plain <= high + 1e-9).all()
    continued = build({**FEW, "trend": "linear"}, 0, 1).fit(rows.commands, rows.positions).predict(far)
    assert (continued < low).any()
    assert (continued > high).any()


def test_the_papers_trees_are_of_depth_two_and_grow_on_all_coordinates_at_once() -> None:
    rows = bending_arm(60)
    forest = build({**SPEC.paper_params}, 0, 1).fit(rows.commands, rows.positions)
    assert len(forest.estimators_) == 100
    assert {tree.get_depth() for tree in forest.estimators_} == {2}
    assert {tree.n_outputs_ for tree in forest.estimators_} == {3}


@pytest.mark.parametrize("trend", ["none", "linear"])
@pytest.mark.parametrize("n_targets", [1, 3])
def test_the_spread_is_the_standard_deviation_over_the_trees(trend: str, n_targets: int) -> None:
    assert SPEC.spread is not None
    rows = bending_arm(80)
    train = Samples(rows.commands, rows.positions[:, :n_targets])
    regressor = build({**FEW, "trend": trend}, 0, 1)
    regressor.fit(train.commands, train.positions if n_targets > 1 else train.positions.ravel())
    forest, scale = (regressor, 1.0) if trend == "none" else (regressor.regressor_, regressor.scale_)
    trees = np.stack([tree.predict(rows.commands).reshape(80, -1) for tree in forest.estimators_])
    spread = SPEC.spread(regressor, train, rows.commands)
    assert spread.shape == (80, n_targets)
    np.testing.assert_allclose(spread, scale * trees.std(axis=0), rtol=1e-9)
    assert not SPEC.is_predictive  # of the noise it knows nothing


def test_threads_change_the_last_bits_of_the_mean_at_most() -> None:
    rows = bending_arm(60)
    one, two = (build(FEW, 0, n).fit(rows.commands, rows.positions) for n in (1, 2))
    assert (one.n_jobs, two.n_jobs) == (1, 2)
    np.testing.assert_allclose(one.predict(rows.commands), two.predict(rows.commands), rtol=1e-12)
