from __future__ import annotations

import io

import joblib
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from sklearn.ensemble import GradientBoostingRegressor, HistGradientBoostingRegressor

from softkin.core.samples import Array
from softkin.models.estimators.boosted_trees import QuantileLoss, boosted_trees

RNG = np.random.default_rng(0)
COMMANDS = RNG.uniform(-1, 1, (200, 2))
TARGETS = COMMANDS[:, 0] + 0.3 * RNG.standard_normal(200)
HIST = {"tree_method": "hist", "max_iter": 15, "max_depth": 3, "max_features": 0.5, "min_samples_leaf": 4}


def predicted(ensemble: GradientBoostingRegressor | HistGradientBoostingRegressor) -> Array:
    return np.asarray(ensemble.fit(COMMANDS, TARGETS).predict(COMMANDS))


def test_without_a_method_they_are_the_papers() -> None:
    params = {"n_estimators": 10, "subsample": 0.5}
    expected = GradientBoostingRegressor(**params, random_state=3)
    np.testing.assert_array_equal(predicted(boosted_trees(params, 3)), predicted(expected))
    expected = GradientBoostingRegressor(loss="quantile", alpha=0.9, **params, random_state=3)
    np.testing.assert_array_equal(predicted(boosted_trees(params, 3, 0.9)), predicted(expected))


def test_histograms_are_scikit_learns() -> None:
    settings = {"max_leaf_nodes": None, "early_stopping": False, "random_state": 3, **HIST}
    del settings["tree_method"]
    np.testing.assert_array_equal(
        predicted(boosted_trees(HIST, 3)), predicted(HistGradientBoostingRegressor(**settings))
    )
    expected = HistGradientBoostingRegressor(loss="quantile", quantile=0.9, **settings)
    np.testing.assert_array_equal(predicted(boosted_trees(HIST, 3, 0.9)), predicted(expected))
    assert HIST["tree_method"] == "hist"


def test_histograms_have_no_early_stopping_and_leaves_without_bound() -> None:
    rows = np.arange(12_000.0)[:, None]
    fitted = boosted_trees({"tree_method": "hist", "max_iter": 3, "max_depth": 6, "min_samples_leaf": 1}, 0)
    fitted.fit(rows, rows[:, 0])
    assert fitted.n_iter_ == 3
    assert fitted._predictors[0][0].get_n_leaf_nodes() > 31


@given(
    arrays(np.float64, st.integers(1, 40), elements=st.floats(-1e6, 1e6)),
    st.sampled_from([0.025, 0.05, 0.1, 0.5, 0.9, 0.95, 0.975]),
)
def test_the_quantile_of_a_leaf_is_numpys_to_the_bit(values: Array, quantile: float) -> None:
    kept = values.copy()
    assert QuantileLoss(quantile=quantile).fit_intercept_only(values) == np.percentile(values, 100 * quantile)
    np.testing.assert_array_equal(values, kept)


def test_weighted_rows_are_left_to_scikit_learn() -> None:
    values, weights = np.array([1.0, 2.0, 5.0]), np.array([1.0, 1.0, 8.0])
    assert QuantileLoss(quantile=0.5).fit_intercept_only(values, weights) == pytest.approx(5.0)


def test_an_ensemble_of_quantiles_can_be_stored() -> None:
    fitted, file = boosted_trees(HIST, 0, 0.1).fit(COMMANDS, TARGETS), io.BytesIO()
    joblib.dump(fitted, file)
    file.seek(0)
    np.testing.assert_array_equal(joblib.load(file).predict(COMMANDS), fitted.predict(COMMANDS))
