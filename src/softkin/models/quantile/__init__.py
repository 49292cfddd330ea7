"""Registry of quantile regressors, for QR and CQR: one file each, one line here."""

from __future__ import annotations

from softkin.models.quantile import gradient_boosting, xgboost
from softkin.models.quantile.spec import QuantileSpec

QUANTILE_MODELS: dict[str, QuantileSpec] = {
    "gb": gradient_boosting.SPEC,
    "xgb": xgboost.SPEC,
}
