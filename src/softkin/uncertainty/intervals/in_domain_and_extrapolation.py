"""Intervals for every command: a calibrated method's in-domain, those of rolling shells in extrapolation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import ShellCalibration
from softkin.uncertainty.conformal import around, conformal_limits, conformal_rank
from softkin.uncertainty.error_growth import train_radius
from softkin.uncertainty.intervals.rolling_shells import half_widths
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod


def intervals(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """In-domain `data.in_domain`, or split conformal prediction; in extrapolation the interval of rolling shells.

    The latter is widened to contain that of split conformal prediction, and `data.in_domain` if that is calibrated on a
    spread: bounds that grow with the distance alone carry no information on errors in extrapolation.

    Of new rows exchangeable with the n of `train`, at most a share 2 / (n + 1) is taken for extrapolation (one may have
    the largest norm, one the widest gap), and the in-domain method loses at most that much coverage.
    """
    deployed, bounds = data.deployed, data.in_domain
    limits = conformal_limits(np.abs(deployed.truth - deployed.calibration), confidence_levels)[:, None]
    if bounds is None:
        bounds = around(deployed.new, np.broadcast_to(limits, (len(limits), *deployed.new.shape)))
    in_extrapolation = is_in_extrapolation(data)
    if not in_extrapolation.any():
        return bounds
    wider = around(deployed.new, np.maximum(limits, half_widths(data, confidence_levels)))
    if data.in_domain_has_spread:
        lower, upper = np.minimum(bounds[..., 0], wider[..., 0]), np.maximum(bounds[..., 1], wider[..., 1])
        wider = np.stack([lower, upper], axis=-1)
    return np.where(in_extrapolation[:, None, None], wider, bounds)


def is_in_extrapolation(data: ShellCalibration) -> NDArray[np.bool_]:
    """Which new commands (n_rows,) lie in extrapolation.

    Those beyond the largest norm of `train`, and those that are farther from their nearest command of `train`, in
    standardised command space, than any command of `train` from its own.
    """
    from sklearn.neighbors import NearestNeighbors
    from sklearn.preprocessing import StandardScaler

    train, new = data.deployed.train_commands, data.deployed.new_commands
    scaler = StandardScaler().fit(train)
    finder = NearestNeighbors(n_neighbors=1).fit(np.unique(scaler.transform(train), axis=0))
    widest_gap = finder.kneighbors()[0].max()
    in_a_gap = finder.kneighbors(scaler.transform(new))[0][:, 0] > widest_gap
    return np.asarray(in_a_gap | (data.norm(new) > train_radius(data)))


METHOD = IntervalMethod(
    "auto",
    "In-domain and extrapolation",
    calibrated_on=ShellCalibration,
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
)
