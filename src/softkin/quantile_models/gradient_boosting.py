"""Gradient boosting of the pinball loss (scikit-learn), one ensemble per quantile: the paper's QR."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from softkin.interface import Params, QuantileSpec


def build(params: Params, quantiles: Sequence[float], seed: int, threads: int) -> Any:
    """One GradientBoostingRegressor(loss="quantile", **params) per quantile."""
    from softkin.estimators.boosted_quantiles import BoostedQuantiles

    return BoostedQuantiles(tuple(quantiles), params, random_state=seed)


SPEC = QuantileSpec("gb", "Gradient boosting", build, paper_params={})
