"""One interval for everywhere: a calibrated one inside the training region, the shells' outside it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import ShellCalibration
from softkin.uncertainty.conformal import around, conformal_limits, conformal_rank
from softkin.uncertainty.error_growth import reach
from softkin.uncertainty.intervals.rolling_shells import half_widths
from softkin.uncertainty.intervals.spec import MARGINAL, IntervalMethod


def intervals(data: ShellCalibration, confidence_levels: Sequence[float]) -> Array:
    """`data.in_domain`, or split conformal prediction, for commands inside, so that `test` is covered as often as
    promised and not more. Outside, the interval of rolling shells, stretched to hold that of split conformal prediction
    and `inside`, where that is informed: one that grows with the distance alone knows nothing of errors out there.

    Of rows exchangeable with the n of `train` at most a share 2 / (n + 1) lies outside (one may reach farthest, one be
    farthest from its neighbours): a method of inside that is not held there loses no more than that.
    """
    deployed, bounds = data.deployed, data.in_domain
    limits = conformal_limits(np.abs(deployed.truth - deployed.calibration), confidence_levels)[:, None]
    if bounds is None:
        bounds = around(deployed.new, np.broadcast_to(limits, (len(limits), *deployed.new.shape)))
    apart = is_in_extrapolation(data)
    if not apart.any():
        return bounds
    beyond = around(deployed.new, np.maximum(limits, half_widths(data, confidence_levels)))
    if data.in_domain_has_spread:
        lower, upper = np.minimum(bounds[..., 0], beyond[..., 0]), np.maximum(bounds[..., 1], beyond[..., 1])
        beyond = np.stack([lower, upper], axis=-1)
    return np.where(apart[:, None, None], beyond, bounds)


def is_in_extrapolation(data: ShellCalibration) -> NDArray[np.bool_]:
    """Which new commands (n_rows,) lie outside the training region: farther out than any of `train`, or, in
    standardised command space, farther from `train` than any command of it lies from the others.
    """
    from sklearn.neighbors import NearestNeighbors
    from sklearn.preprocessing import StandardScaler

    train, new = data.deployed.train_commands, data.deployed.new_commands
    scaler = StandardScaler().fit(train)
    finder = NearestNeighbors(n_neighbors=1).fit(np.unique(scaler.transform(train), axis=0))
    widest_gap = finder.kneighbors()[0].max()
    apart = finder.kneighbors(scaler.transform(new))[0][:, 0] > widest_gap
    return np.asarray(apart | (data.norm(new) > reach(data)))


METHOD = IntervalMethod(
    "auto",
    "Inside and outside",
    calibrated_on=ShellCalibration,
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
)
