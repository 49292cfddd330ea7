"""The region of a calibrated model that holds a whole pose: its shape, chosen on `train`, and what sets its size."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from sklearn.model_selection import KFold

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import Shell
from softkin.uncertainty.promise import Promise
from softkin.uncertainty.regions import box, ellipsoids
from softkin.uncertainty.regions.spec import Shape, of_shape

#: From residuals on `train` and the marker of each coordinate to a shape.
Maker = Callable[[Array, NDArray[np.intp]], Shape]
#: The shapes that are compared; earlier ones win ties.
SHAPES: tuple[Maker, ...] = (box.shape, ellipsoids.shape)
#: The level and the folds of `train` at which shapes are compared.
COMPARED_AT, N_FOLDS = 0.9, 5


@dataclass(frozen=True)
class JointRegion:
    """A joint region up to its size, and the sizes from which on it holds the rows that calibrate it.

    `shape` is of the `moving` coordinates (n_coordinates,); `scores` (n_calibration,) are those sizes. `shells` hold
    sizes as errors (n_shell, 1): what the region must grow to beyond cores of `train`. `constant` (n_coordinates,) in
    mm is the largest error of each constant coordinate on the calibration set, 0 for moving ones. `promise`: of blocks,
    where these are exchangeable and not rows.
    """

    shape: Shape
    moving: NDArray[np.bool_]
    scores: Array
    shells: Sequence[Shell]
    constant: Array
    promise: Promise | None = None

    @property
    def markers(self) -> NDArray[np.intp]:
        """Marker (n_moving,) of each moving coordinate."""
        return np.asarray(np.flatnonzero(self.moving) // 3)


def joint_region(
    train_residuals: Array,
    residuals: Array,
    moving: NDArray[np.bool_],
    shells: Sequence[Shell],
    promise: Promise | None = None,
) -> JointRegion:
    """The joint region around a model.

    Parameters:
        train_residuals: true minus predicted positions (n_train, n_coordinates) in mm, which alone decide the shape.
        residuals: those of the calibration set (n_calibration, n_coordinates).
        moving: which coordinates (n_coordinates,) move.
        shells: what the same model predicts beyond cores of `train`.
        promise: of the blocks of the calibration set; None where rows are exchangeable.
    """
    shape = chosen_shape(train_residuals[:, moving], np.flatnonzero(moving) // 3)
    constant = np.where(moving, 0.0, np.abs(residuals).max(axis=0))
    beyond = []
    for shell in shells:
        scores = shape.scores((shell.truth - shell.predicted)[:, moving])[:, None]
        beyond.append(replace(shell, predicted=np.zeros_like(scores), truth=scores))
    return JointRegion(shape, moving, shape.scores(residuals[:, moving]), beyond, constant, promise)


def chosen_shape(train_residuals: Array, markers: NDArray[np.intp]) -> Shape:
    """The shape of the smallest region: shaped on four folds of `train`, sized on the fifth, five times; on all of
    `train`. Ties, and sizes that are infinite since rows are few, go to the box.

    Parameters:
        train_residuals: of the moving coordinates (n_train, n_moving) in mm.
        markers: marker (n_moving,) of each.
    """
    folds = list(KFold(N_FOLDS, shuffle=True, random_state=0).split(train_residuals))

    def log_size(shape: Maker) -> float:
        parts = ((train_residuals[most], train_residuals[rest]) for most, rest in folds)
        sizes = [of_shape(shape(most, markers), rest, COMPARED_AT).size_mm for most, rest in parts]
        return float(np.log(np.maximum(sizes, np.finfo(float).tiny)).mean())

    return min(SHAPES, key=log_size)(train_residuals, markers)
