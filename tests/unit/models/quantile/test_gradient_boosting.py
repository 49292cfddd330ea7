from __future__ import annotations

import numpy as np
from optuna.trial import FixedTrial
from sklearn.ensemble import GradientBoostingRegressor, HistGradientBoostingRegressor

from softkin.models.estimators.boosted_quantiles import BoostedQuantiles
from softkin.models.quantile.gradient_boosting import SPEC

RNG = np.random.default_rng(0)
COMMANDS = RNG.uniform(-1, 1, (200, 2))
TARGETS = COMMANDS[:, 0] + 0.3 * RNG.standard_normal(200)


def test_the_papers_settings_are_scikit_learns_one_ensemble_per_quantile() -> None:
    fitted = SPEC.build({**SPEC.paper_params}, [0.05, 0.95], 3, 1).fit(COMMANDS, TARGETS)
    assert isinstance(fitted, BoostedQuantiles)
    assert len(fitted.models_) == 2
    upper = GradientBoostingRegressor(loss="quantile", alpha=0.95, random_state=3).fit(COMMANDS, TARGETS)
    np.testing.assert_array_equal(fitted.predict(COMMANDS)[:, 1], upper.predict(COMMANDS))


def test_a_searched_one_is_a_histograms() -> None:
    params = SPEC.search_space(FixedTrial(dict(SPEC.first_trials[0])))
    fitted = SPEC.build(params, [0.05, 0.95], 3, 1).fit(COMMANDS, TARGETS)
    assert all(isinstance(model, HistGradientBoostingRegressor) for model in fitted.models_)


def test_around_a_trend_all_quantiles_keep_their_order_far_away() -> None:
    fitted = SPEC.build({"n_estimators": 20, "trend": "linear"}, [0.1, 0.5, 0.9], 0, 1).fit(COMMANDS, TARGETS)
    predicted = fitted.predict(np.array([[-5.0, 0.0], [5.0, 0.0]]))
    assert predicted.shape == (2, 3)
    assert (np.diff(predicted, axis=1) > 0).all()
    assert (predicted[0] < -3).all()
    assert (predicted[1] > 3).all()
