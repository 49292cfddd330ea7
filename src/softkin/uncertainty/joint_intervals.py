"""Regions that hold whole poses: what a calibrated model answers to `joint_intervals`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.stats import norm, t

from softkin.core.metrics.interval import geometric_size
from softkin.core.samples import Array
from softkin.uncertainty import calls
from softkin.uncertainty.answers import bounds_frame, index_of, like
from softkin.uncertainty.beyond import Beyond
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import conformal_limits
from softkin.uncertainty.new_session import unseen_zero
from softkin.uncertainty.promise import asked_levels
from softkin.uncertainty.recalibration import PRIOR_POSES
from softkin.uncertainty.regions.spec import divided


@dataclass(frozen=True, eq=False, repr=False)
class JointIntervals:
    """A region for each command, and at each confidence level, that holds all moving coordinates at once.

    `kind` is `box` or `ellipsoids`, one around each marker. `centre` (n_rows, n_coordinates) is the predicted pose;
    `bounds` (n_levels, n_rows, n_coordinates, 2) are those of the region along the axes, of a box the region itself; in
    mm. `matrices` (n_levels, n_rows, n_markers, 3, 3) in mm2 are those of ellipsoids, a marker x within where
    (x - centre)' inverse(matrix) (x - centre) <= 1, with zeros for constant coordinates; None of a box. In a session
    never seen regions are boxes. Of one level given as a number there is no axis of levels. To a DataFrame, centre and
    bounds are DataFrames as of `intervals`. Where the pose may fail, the region is the box of its bounds, which hold
    the failed poses of `train`, too. `sizes_mm` (n_levels, n_rows) is the side of a cube of the same volume, in all
    moving coordinates together. At a level for which the calibration set has too few rows a region is infinite; where
    it has too few blocks, a region reaches to the largest error and promises nothing.
    """

    kind: str
    centre: Array | pd.DataFrame
    bounds: Array | pd.DataFrame
    matrices: Array | None
    sizes_mm: Array
    _asked: calls.Rows
    _levels: tuple[list[float], bool]
    _moving: NDArray[np.bool_]
    _names: calls.Names
    _where: str
    _sides: Array
    _may_fail: NDArray[np.bool_]
    _bounds: Array

    def contains(self, positions: calls.Rows) -> NDArray[np.bool_] | pd.Series | pd.DataFrame:
        """Whether each region holds the whole pose (n_levels, n_rows), of measured positions (n_rows, n_coordinates) in
        mm; of one level (n_rows,). Constant coordinates do not count.

        Raises:
            DataError: they are no such positions, or a table of other rows than the commands.
        """
        calls.check_same_rows(self._asked, positions, self._where)
        centre = np.asarray(self.centre)
        measured = calls.position_rows(positions, self._names, len(centre), self._where)
        off = measured - centre
        if self.matrices is None:
            sides = self._sides[..., self._moving]
            held = (np.abs(off[:, self._moving]) <= sides).all(axis=-1)
        else:
            held = self._in_ellipsoids(off, self.matrices)
        low, high = np.moveaxis(self._bounds, -1, 0)
        within = ((low <= measured) & (measured <= high))[..., self._moving].all(axis=-1)
        held = np.where(self._may_fail, within, held)
        (levels, is_one), asked = self._levels, self._asked
        if isinstance(asked, (pd.DataFrame, pd.Series)):
            table = pd.DataFrame(held.T, index_of(asked), levels)
            return table.iloc[:, 0].rename("held") if is_one else table
        return held[0] if is_one else held

    def _in_ellipsoids(self, off: Array, matrices: Array) -> NDArray[np.bool_]:
        """Whether all ellipsoids hold their markers (n_levels, n_rows), `off` by (n_rows, n_coordinates) in mm."""
        shape = self._sides.shape[:2]
        matrices = np.reshape(matrices, (*shape, -1, 3, 3))
        everything = np.asarray(np.isinf(self._sides).any(axis=-1))
        held = np.ones(shape, dtype=bool)
        for marker in np.unique(np.flatnonzero(self._moving) // 3):
            axes = np.flatnonzero(self._moving[3 * marker : 3 * marker + 3])
            block = matrices[:, :, marker][..., axes[:, None], axes]
            block = np.where(everything[..., None, None], np.eye(len(axes)), block)
            rows = np.broadcast_to(off[:, 3 * marker + axes], (*shape, len(axes)))
            distance = (rows * np.linalg.solve(block, rows[..., None])[..., 0]).sum(axis=-1)
            held &= distance <= 1
        return held | everything

    def __repr__(self) -> str:
        levels = ", ".join(f"{level:g}" for level in self._levels[0])
        return f"{self.kind} around {len(self._sides[0])} poses of {self._where}, each whole, at {levels}"


class JointAnswers:
    """The joint regions of a calibrated model, with what does not depend on the command worked out once."""

    def __init__(self, robot: Any) -> None:
        self.robot, region = robot, robot.joint
        zeros = np.zeros((len(region.scores), 1))
        known = PointCalibration(
            zeros, region.scores[:, None], zeros[:0], robot.known.train_commands, robot.known.calibration_commands,
            robot.known.new_commands,
        )  # fmt: skip
        self.sizes = Beyond(known, region.shells, robot.norm)

    def intervals(self, commands: calls.Rows, confidence_levels: float | Sequence[float] | Array) -> JointIntervals:
        """As `CalibratedModel.joint_intervals`."""
        robot, region = self.robot, self.robot.joint
        inputs = calls.command_rows(commands, robot.names, robot._n_inputs, robot.dataset)
        levels, is_one = calls.levels_of(confidence_levels, robot.dataset)
        size = self._size(inputs, tuple(levels))[..., None] * self._stretch(levels)
        zero = self._zero(inputs, levels)
        centre = np.asarray(robot.predict(inputs))
        sides = np.broadcast_to(region.constant, (len(levels), *centre.shape)).copy()
        sides[..., region.moving] = size * region.shape.half_widths
        if zero is not None:
            sides[..., region.moving] = np.hypot(sides[..., region.moving], zero)
        bounds = np.stack([centre - sides, centre + sides], axis=-1)
        may_fail = np.zeros(bounds.shape[:2], dtype=bool)
        if robot.failures is not None:
            own = inputs[:, : robot.train.commands.shape[1]]
            may_fail, bounds = robot.failures.may_fail(own, levels), robot.failures.widened(bounds, own, levels)
        is_box = region.shape.matrix is None or zero is not None
        matrices = None if is_box else self._matrices(region.shape.matrix, size)
        sizes_mm = geometric_size(np.ptp(bounds[..., region.moving, :], axis=-1))
        if not is_box:
            sizes_mm = np.where(may_fail, sizes_mm, region.shape.unit_size_mm * geometric_size(size))
        is_table = isinstance(commands, (pd.DataFrame, pd.Series))
        answer: Any = bounds[0] if is_one else bounds
        if is_table:
            answer = bounds_frame(commands, bounds, None if is_one else levels, robot.names.coordinates)
        return JointIntervals(
            "box" if is_box else region.shape.kind,
            like(commands, centre, robot.names.coordinates),
            answer,
            matrices[0] if matrices is not None and is_one else matrices,
            sizes_mm[0] if is_one else sizes_mm,
            commands if is_table else None,
            (levels, is_one),
            region.moving,
            robot.names,
            robot.dataset,
            sides,
            may_fail,
            bounds,
        )

    def _size(self, inputs: Array, levels: tuple[float, ...]) -> Array:
        """Size (n_levels, n_rows) of the region: the conformal limit, where blocks are exchangeable at the level that
        is promised of blocks; in extrapolation that of rolling shells.
        """
        levels = asked_levels(self.robot.joint.promise, levels)
        limits = conformal_limits(self.robot.joint.scores[:, None], levels)
        size = np.broadcast_to(limits, (len(levels), len(inputs)))
        outside = np.asarray(self.robot.is_outside(inputs)) if self.sizes.has_shells else np.zeros(0, dtype=bool)
        if not outside.any():
            return size
        commands = inputs[:, : self.robot.train.commands.shape[1]]
        return np.where(outside, self.sizes.half_widths(commands, levels)[..., 0], size)

    def _stretch(self, levels: Sequence[float]) -> Array:
        """How many times (n_levels, 1, n_moving) the errors of each coordinate are those of the calibration set: 1, or
        what a recalibration says at the level that each coordinate has where all are to be held at once.
        """
        found, region = self.robot.recalibration, self.robot.joint
        if found is None:
            return np.ones((len(levels), 1, int(region.moving.sum())))
        tail = (1 + np.asarray(self._single(levels))) / 2
        farther = t.ppf(tail, PRIOR_POSES + found.n_poses - 1) / norm.ppf(tail)
        return np.asarray(farther[:, None, None] * found.stretch[region.moving])

    def _zero(self, inputs: Array, levels: Sequence[float]) -> Array | None:
        """How far (n_levels, n_rows, n_moving) in mm the zero of a session never seen may lie; None where no row is of
        one.
        """
        if self.robot.recalibration is not None:
            return None
        zero = unseen_zero(self.robot.estimator, inputs, self._single(levels))
        return None if zero is None else np.asarray(zero[..., self.robot.joint.moving])

    def _single(self, levels: Sequence[float]) -> list[float]:
        """The level of each coordinate at which all are held at each of these levels, by Bonferroni."""
        return [divided(level, int(self.robot.joint.moving.sum())) for level in levels]

    def _matrices(self, matrix: Array, size: Array) -> Array:
        """Matrices (n_levels, n_rows, n_markers, 3, 3) in mm2: the blocks of `matrix` times `size` (n_levels, n_rows,
        n_moving) on both sides.
        """
        moving, everything = self.robot.joint.moving, np.asarray(np.isinf(size).any(axis=-1))[..., None, None]
        size, places = np.where(np.isinf(size), 1.0, size), np.flatnonzero(self.robot.joint.moving)
        result = np.zeros((*size.shape[:2], len(moving) // 3, 3, 3))
        for marker in np.unique(places // 3):
            own = np.flatnonzero(places // 3 == marker)
            axes, of_axes = places[own] % 3, size[..., own]
            block = matrix[np.ix_(own, own)] * of_axes[..., :, None] * of_axes[..., None, :]
            infinite = np.where(np.eye(len(own), dtype=bool), np.inf, 0.0)
            result[:, :, marker][..., axes[:, None], axes] = np.where(everything, infinite, block)
        return result
