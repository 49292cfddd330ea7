"""Registry of interval methods: one file a method, one line here."""

from __future__ import annotations

from typing import Any

from softkin.uncertainty.intervals import (
    conformal_predictive_system,
    conformalized_quantile_regression,
    cross_validation_plus,
    gaussian,
    in_domain_and_extrapolation,
    jackknife_plus_after_bootstrap,
    quantile_regression,
    rolling_shells,
    shell,
    split_conformal_crepes,
    split_conformal_distance,
    split_conformal_held_out,
    split_conformal_mapie,
    split_conformal_spread,
)
from softkin.uncertainty.intervals.spec import IntervalMethod

#: The paper's four in the order of its Table 6, then ours.
INTERVAL_METHODS: dict[str, IntervalMethod[Any]] = {
    "qr": quantile_regression.METHOD,
    "cqr": conformalized_quantile_regression.METHOD,
    "scp_mapie": split_conformal_mapie.METHOD,
    "scp_crepes": split_conformal_crepes.METHOD,
    "cqr_asymmetric": conformalized_quantile_regression.ASYMMETRIC,
    "scp_distance": split_conformal_distance.METHOD,
    "scp_spread": split_conformal_spread.METHOD,
    "scp_held_out": split_conformal_held_out.METHOD,
    "cps": conformal_predictive_system.METHOD,
    "gaussian": gaussian.METHOD,
    "cv_plus": cross_validation_plus.METHOD,
    "jackknife_plus_ab": jackknife_plus_after_bootstrap.METHOD,
    "shell": shell.METHOD,
    "shell_matched": shell.MATCHED,
    "rolling_shells": rolling_shells.METHOD,
    "auto": in_domain_and_extrapolation.METHOD,
}
