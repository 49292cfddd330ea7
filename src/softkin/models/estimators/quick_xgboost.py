"""XGBoost's regressor without what its training does beside boosting, equal to the bit."""

from __future__ import annotations

from typing import Any, Self

from xgboost import Booster, XGBRegressor

from softkin.core.samples import Array


class QuickXGBoost(XGBRegressor):
    """XGBRegressor whose trees stay as they were grown.

    XGBoost ends a fit by writing the model out and reading it back, to free what it was trained on: a quarter of a fit
    on a few hundred rows. Here that is freed with the regressor. Of `fit` itself it takes rows and targets alone.
    """

    def fit(self, X: Array, y: Array) -> Self:
        """Fit on commands X (n_rows, n_commands) and targets y (n_rows, n_targets), or (n_rows,) of one target."""
        rows: dict[str, Any] = {"data": X, "label": y, "missing": self.missing}
        matrix = self._create_dmatrix(ref=None, enable_categorical=self.enable_categorical, **rows)
        booster = Booster(self.get_xgb_params(), [matrix])
        for place in range(self.get_num_boosting_rounds()):
            booster.update(matrix, place)
        self._Booster = booster
        return self
