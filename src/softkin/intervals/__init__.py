"""Interval methods: one file a method, one line here."""

from __future__ import annotations

from softkin.interface import IntervalMethod
from softkin.intervals import (
    conformalized_quantile_regression,
    quantile_regression,
    split_conformal_crepes,
    split_conformal_mapie,
)

#: In the order of the paper's Table 6.
INTERVAL_METHODS: dict[str, IntervalMethod] = {
    "qr": quantile_regression.METHOD,
    "cqr": conformalized_quantile_regression.METHOD,
    "scp_mapie": split_conformal_mapie.METHOD,
    "scp_crepes": split_conformal_crepes.METHOD,
}
