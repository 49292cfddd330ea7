"""Check for gross outliers: rows whose pose lies far from a robust smooth fit, and from the rows around them.

Far means both: beyond the limits of the fit at `FAR_SCALES` standard deviations, and by more than `FAR_SHARE` of the
coordinate's extent. Comparing with the neighbours' residuals spares regions where the fit is poor or the robot noisy.
Rows that share their pose with another command are left to the check of stuck poses.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import (
    chunks,
    command_scale,
    first_of_each,
    row_groups,
    sampled_rows,
    shares_its_pose,
    split_by_subset,
    stacked_commands,
    stacked_positions,
)
from softkin.core.samples import TRAIN, Array, Samples, informative_coordinates
from softkin.core.smooth_fit import SmoothFit, fit_smoothly
from softkin.data.audit.findings import WARNING, CheckResult, counted, finding_of_rows

FAR_SCALES, FAR_SHARE = 10.0, 0.01
N_NEIGHBOURS = 20
#: This many of the worst rows are compared with their neighbours, which are sought among this many rows.
MAX_CANDIDATES, MAX_NEIGHBOUR_ROWS = 5_000, 100_000


def check(samples: Mapping[str, Samples], seed: int = 0) -> CheckResult:
    """At most one finding, on all subsets."""
    moving = informative_coordinates(samples[TRAIN].positions)
    if not moving.any():
        return CheckResult((), {"not_measured": "no coordinate moves"})
    commands, positions = stacked_commands(samples), stacked_positions(samples, moving)
    mask, fit, worst = far_off(commands, positions, command_scale(samples[TRAIN].commands), seed)
    numbers: dict[str, Any] = {"degree_of_fit": fit.degree, "rows_fitted": fit.n_fitted}
    if fit.degree == 0:
        return CheckResult((), numbers | {"not_measured": "too few distinct rows to fit a plane through"})
    marked = {subset: part.astype(bool) for subset, part in split_by_subset(mask, samples).items()}
    numbers |= {
        "rows": {subset: int(part.sum()) for subset, part in marked.items()},
        "largest_miss_mm": worst,
        "typical_residual_mm": float(np.median(fit.scale)),
    }
    if not mask.any():
        return CheckResult((), numbers)
    finding = finding_of_rows(
        "gross_outliers",
        WARNING,
        marked,
        f"{counted(int(mask.sum()), 'row')} lie up to {worst:.3g} mm from where the rows around them say that the "
        f"robot is; a typical row lies {numbers['typical_residual_mm']:.2g} mm off.",
        "The cause is probably a lost or swapped marker, or a failed simulation. A few such rows dominate the RMSE: "
        "check them before you trust it, and read the MAE and the 95th percentile.",
    )
    return CheckResult((finding,), numbers)


def far_off(
    commands: Array, positions: Array, scale: Array, seed: int = 0
) -> tuple[NDArray[np.bool_], SmoothFit, float]:
    """Mask (n_rows,) of the gross outliers among commands (n_rows, n_commands) and moving coordinates (n_rows,
    n_coordinates) in mm, the fit that they are far from, and how far (mm) the worst one is off.

    Neighbours are sought among commands in units of their `scale` (n_commands,). No row where the rows are too few to
    fit a plane through: the fit has degree 0.
    """
    from sklearn.neighbors import NearestNeighbors

    poses = row_groups(positions)
    fit = fit_smoothly(commands, positions, first_of_each(poses), seed)
    mask = np.zeros(len(commands), dtype=bool)
    if fit.degree == 0:
        return mask, fit, 0.0
    limit = np.maximum(FAR_SCALES * fit.scale, FAR_SHARE * fit.extent)
    excess = np.empty(len(commands))
    for part in chunks(len(commands)):
        excess[part] = (np.abs(fit.residuals(commands[part], positions[part])) / limit).max(axis=1)
    excess[shares_its_pose(poses, row_groups(commands))] = 0.0
    candidates = np.flatnonzero(excess > 1)
    candidates = candidates[np.argsort(-excess[candidates], kind="stable")[:MAX_CANDIDATES]]
    if not len(candidates):
        return mask, fit, 0.0
    scaled = commands / scale
    others = sampled_rows(len(commands), MAX_NEIGHBOUR_ROWS, seed)
    tree = NearestNeighbors(n_neighbors=min(N_NEIGHBOURS, len(others))).fit(scaled[others])
    neighbours = others[tree.kneighbors(scaled[candidates], return_distance=False)]
    around = fit.residuals(commands[neighbours.ravel()], positions[neighbours.ravel()])
    around = around.reshape(*neighbours.shape, -1)
    middle = np.median(around, axis=1)
    spread = 1.4826 * np.median(np.abs(around - middle[:, None]), axis=1)
    residuals = fit.residuals(commands[candidates], positions[candidates])
    misses = np.abs(residuals - middle)
    limits = np.maximum(limit, fit.limits(commands[candidates], FAR_SCALES))
    far = (np.abs(residuals) > limits) & (misses > np.maximum(limits, FAR_SCALES * spread))
    mask[candidates[far.any(axis=1)]] = True
    return mask, fit, float(misses[far].max(initial=0.0))
