"""Learners of quantiles, for QR and CQR: one file a learner, one line here."""

from __future__ import annotations

from softkin.interface import QuantileSpec
from softkin.quantile_models import gradient_boosting, xgboost

QUANTILE_MODELS: dict[str, QuantileSpec] = {
    "gb": gradient_boosting.SPEC,
    "xgb": xgboost.SPEC,
}
