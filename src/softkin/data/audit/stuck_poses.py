"""Check for stuck poses: rows with a command of their own and, bit for bit, the pose of another row, which is wrong.

A shared pose alone proves nothing: with coarse position sensors, dead zones and redundant actuators, commands share
poses rightly. So a row is stuck when, besides, its pose lies far from a smooth fit through the other rows. Where a
solver kept its last converged pose, the row that did converge is therefore not stuck.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import (
    Indices,
    first_of_each,
    row_groups,
    shares_its_pose,
    split_by_subset,
    stacked_commands,
    stacked_positions,
)
from softkin.core.samples import TRAIN, Array, Samples, informative_coordinates
from softkin.core.smooth_fit import fit_smoothly
from softkin.data.audit.findings import WARNING, CheckResult, counted, finding_of_rows

#: Far off the fit is farther than both, in any coordinate: standard deviations, and share of the coordinate's extent.
FAR_SCALES, FAR_SHARE = 10.0, 0.001


def stuck(commands: Array, positions: Array, seed: int = 0) -> tuple[NDArray[np.bool_], Indices, float]:
    """Mask (n_rows,) of stuck rows, the pose number (n_rows,) of each row, and how far (mm) the worst row is off.

    `positions` (n_rows, n_coordinates) are moving coordinates in mm. Where the rows are too few to fit a plane
    through, every row of a shared pose counts, and the distance is 0.
    """
    poses = row_groups(positions)
    sharing = np.flatnonzero(shares_its_pose(poses, row_groups(commands)))
    mask = np.zeros(len(poses), dtype=bool)
    if not len(sharing):
        return mask, poses, 0.0
    fit = fit_smoothly(commands, positions, first_of_each(poses), seed)
    if fit.degree == 0:
        mask[sharing] = True
        return mask, poses, 0.0
    misses = np.abs(fit.residuals(commands[sharing], positions[sharing]))
    far = (misses > np.maximum(fit.limits(commands[sharing], FAR_SCALES), FAR_SHARE * fit.extent)).any(axis=1)
    mask[sharing[far]] = True
    return mask, poses, float(misses[far].max(initial=0.0))


def check(samples: Mapping[str, Samples], seed: int = 0) -> CheckResult:
    """At most one finding, on all subsets."""
    moving = informative_coordinates(samples[TRAIN].positions)
    if not moving.any():
        return CheckResult((), {"not_measured": "no coordinate moves"})
    mask, poses, worst = stuck(stacked_commands(samples), stacked_positions(samples, moving), seed)
    marked = {subset: part.astype(bool) for subset, part in split_by_subset(mask, samples).items()}
    n_poses = len(np.unique(poses[mask]))
    numbers = {
        "rows": {subset: int(part.sum()) for subset, part in marked.items()},
        "poses": n_poses,
        "largest_miss_mm": worst,
    }
    if not mask.any():
        return CheckResult((), numbers)
    distance = f", up to {worst:.3g} mm from where the rows around them say that the robot is" if worst else ""
    finding = finding_of_rows(
        "stuck_poses",
        WARNING,
        marked,
        f"{counted(int(mask.sum()), 'row')} have a command of their own but exactly the pose of another row "
        f"({counted(n_poses, 'pose')} in all){distance}.",
        "These positions are wrong: a simulation failed or a sensor froze. They dominate the RMSE and the widest "
        "intervals: read the MAE and the 95th percentile. `clean` in the dataset's entry drops those of train.",
    )
    return CheckResult((finding,), numbers)
