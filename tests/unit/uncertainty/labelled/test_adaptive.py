from __future__ import annotations

import numpy as np
import pytest
from mapie.conformity_scores import AbsoluteConformityScore
from mapie.regression import TimeSeriesRegressor

from softkin.models.estimators.column import Column
from softkin.uncertainty.conformal import global_random_state_kept
from softkin.uncertainty.labelled.adaptive import STEP, answer, trajectory
from tests.unit.uncertainty.conftest import LEVELS
from tests.unit.uncertainty.labelled.conftest import labelled


def test_rows_are_taken_by_their_norm_and_answered_in_their_own_order() -> None:
    rows = labelled(m=30)
    order = np.argsort(rows.norm(rows.commands), kind="stable")
    half_widths = answer(rows, [0.9], 0).half_widths[0]
    along = trajectory(np.abs(rows.calibration_errors), np.abs(rows.errors)[order], 0.9)
    np.testing.assert_array_equal(half_widths[order], along)


def test_misses_are_as_many_as_nominal_whatever_comes() -> None:
    """Gibbs and Candes, proposition 4.1, on errors that grow a hundredfold on the way."""
    rng = np.random.default_rng(0)
    scores = np.abs(rng.standard_normal((500, 4))) * np.geomspace(1, 100, 500)[:, None]
    start = np.abs(rng.standard_normal((100, 4)))
    for level in LEVELS:
        misses = (scores > trajectory(start, scores, level)).mean(axis=0)
        bound = (max(level, 1 - level) + STEP) / (STEP * 500)
        assert (np.abs(misses - (1 - level)) <= bound).all()
        frozen = np.sort(start, axis=0)[int(level * 101)]
        assert ((scores > frozen).mean(axis=0) > 0.5).all()


def test_it_is_mapies_where_that_does_not_clip() -> None:
    """MAPIE as it is used: predict a row, adapt the level, update the scores."""
    rng = np.random.default_rng(3)
    start, scores = rng.standard_normal(60), rng.standard_normal(40)
    ours = trajectory(np.abs(start)[:, None], np.abs(scores)[:, None], 0.8, step=0.01)[:, 0]
    zero = np.zeros((1, 1))
    with global_random_state_kept():
        mapie = TimeSeriesRegressor(
            Column(0), method="aci", cv="prefit", conformity_score=AbsoluteConformityScore(sym=True)
        )
        mapie.fit(np.zeros((60, 1)), start)
        theirs = []
        for score in scores:
            _, bounds = mapie.predict(zero, confidence_level=0.8, allow_infinite_bounds=True)
            theirs.append(float(bounds[0, 1, 0]))
            mapie.adapt_conformal_inference(zero, np.array([score]), gamma=0.01)
            with pytest.warns(UserWarning, match="changed"):
                mapie.update(zero, np.array([score]))
    np.testing.assert_allclose(ours, theirs, atol=1e-12)
    assert len(np.unique(ours)) > 5
