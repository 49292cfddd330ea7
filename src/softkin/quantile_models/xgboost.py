"""XGBoost's multi-quantile objective: all quantiles in one ensemble."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from softkin.interface import Params, QuantileSpec


def build(params: Params, quantiles: Sequence[float], seed: int, threads: int) -> Any:
    """XGBRegressor(objective="reg:quantileerror", **params)."""
    from xgboost import XGBRegressor

    return XGBRegressor(
        objective="reg:quantileerror", quantile_alpha=list(quantiles), **params, random_state=seed, n_jobs=threads
    )


SPEC = QuantileSpec("xgb", "XGBoost", build, paper_params={})
