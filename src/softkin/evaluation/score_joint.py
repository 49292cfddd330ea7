"""Score the joint intervals of a calibrated model: how often they hold a whole pose, and how large they are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from softkin.core.samples import Samples
from softkin.evaluation.score_regions import JOINT, coverage_row
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.regions.spec import JOINT_INTERVALS


def joint_rows(
    robot: CalibratedModel, samples: Mapping[str, Samples], confidence_levels: Sequence[float]
) -> Iterator[dict[str, Any]]:
    """A row of interval_metrics.csv per level and subset, around the deployed run; `shape` is box or ellipsoids.

    The size is the median over rows of the side (mm) of a cube of the same volume: where rows may fail it is huge.
    Recorded rows are told their session and memory. `samples` is subset -> rows, of test and extrapolation.
    """
    promise = robot.joint.promise
    guarantees = [JOINT if promise is None else promise.of_region(JOINT, level) for level in confidence_levels]
    for subset, rows in samples.items():
        regions = robot.joint_intervals(rows.inputs, confidence_levels)
        held, sizes = np.asarray(regions.contains(rows.positions)), regions.sizes_mm
        for place, level in enumerate(confidence_levels):
            yield {
                "model": robot.spec.name,
                "preset": robot.preset,
                "interval_method": JOINT_INTERVALS,
                **coverage_row(subset, level, held[place], len(robot.joint.scores), rows.block, guarantees[place]),
                "infinite_share": float(np.isinf(sizes[place]).mean()),
                "size_mm": float(np.median(sizes[place])),
                "shape": regions.kind,
            }
