"""Made-up calibration data of every kind, whose new rows are exchangeable with the calibration rows."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import (
    CalibrationData,
    FoldCalibration,
    HeldOutCalibration,
    PointCalibration,
    PredictiveCalibration,
    QuantileCalibration,
    RefitCalibration,
    ResampleCalibration,
    Shell,
    ShellCalibration,
    SpreadCalibration,
)
from softkin.uncertainty.held_out_difficulty import fit_difficulty

N_TRAIN, N_NEW, N_COORDINATES = 300, 40, 3
LEVELS = (0.8, 0.9, 0.95)
SCALE = np.arange(1.0, 1 + N_COORDINATES)

Made = tuple[CalibrationData, Array]


def norm(commands: Array) -> Array:
    return np.asarray(np.linalg.norm(commands, axis=1))


def _rows(n_rows: int, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Commands (n_rows, 2), predictions and true positions (n_rows, n_coordinates): errors grow with the norm."""
    commands = rng.uniform(-1, 1, (n_rows, 2))
    truth = 10 * rng.standard_normal((n_rows, N_COORDINATES))
    errors = rng.standard_t(3, truth.shape) * (0.5 + norm(commands))[:, None] * SCALE
    return commands, truth + errors, truth


def _points(n: int, rng: np.random.Generator) -> tuple[PointCalibration, Array]:
    (train_commands, *_), calibration, new = _rows(N_TRAIN, rng), _rows(n, rng), _rows(N_NEW, rng)
    data = PointCalibration(
        calibration[1], calibration[2], new[1], train_commands, calibration_commands=calibration[0], new_commands=new[0]
    )
    return data, new[2]


def _with_difficulty(n: int, rng: np.random.Generator) -> Made:
    """Hard where errors on held-out rows were large: far from the mean command."""
    data, truth = _points(n, rng)
    commands, predicted, held_out = _rows(N_TRAIN, rng)
    difficulty = fit_difficulty(commands, np.abs(predicted - held_out), np.arange(N_COORDINATES))
    return HeldOutCalibration(**vars(data), difficulty=difficulty), truth


def _with_spread(kind: type[SpreadCalibration]) -> Callable[[int, np.random.Generator], Made]:
    def make(n: int, rng: np.random.Generator) -> Made:
        data, truth = _points(n, rng)
        commands = (data.train_commands, data.calibration_commands, data.new_commands)
        return kind(**vars(data), **dict(zip(_SPREADS, map(_spread, commands), strict=True))), truth

    return make


_SPREADS = ("train_spread", "calibration_spread", "new_spread")


def _spread(commands: Array) -> Array:
    return np.asarray((0.5 + norm(commands))[:, None] * SCALE)


def _quantiles(n: int, rng: np.random.Generator) -> Made:
    points, truth = _points(n, rng)
    half = np.array([1.0, 1.5, 2.0])[:, None, None]
    calibration, new = (np.stack([at - half, at + half], axis=-1) for at in (points.calibration, points.new))
    return QuantileCalibration(calibration, points.truth, new, LEVELS), truth


def _refits(kind: type[RefitCalibration]) -> Callable[[int, np.random.Generator], Made]:
    """Each fit predicts the mean of the rows it is fitted on."""

    def make(n: int, rng: np.random.Generator) -> Made:
        truth = rng.standard_t(3, (n + N_NEW, N_COORDINATES)) * SCALE
        fold_of_row = rng.permutation(np.arange(n) % 5)
        fitted_rows = (
            [np.flatnonzero(fold_of_row != fold) for fold in range(5)]
            if kind is FoldCalibration
            else list(rng.integers(n, size=(30, n)))
        )
        means = np.stack([truth[rows].mean(axis=0) for rows in fitted_rows])[:, None]
        train, new = (np.broadcast_to(means, (len(means), size, N_COORDINATES)).copy() for size in (n, N_NEW))
        return kind(fitted_rows, train, truth[:n], new), truth[n:]

    return make


def _shells(n: int, rng: np.random.Generator) -> Made:
    """Cores within 0.5, 0.7 and 0.85 of the corner of the box that `train` fills."""
    deployed, truth = _points(n, rng)
    train = deployed.train_commands
    shells = []
    for radius in (0.5, 0.7, 0.85):
        commands = train[norm(train) > radius]
        positions = rng.standard_normal((len(commands), N_COORDINATES))
        errors = rng.standard_normal(positions.shape) * norm(commands)[:, None] ** 2
        shells.append(Shell(train[norm(train) <= radius], commands, positions + errors, positions))
    return ShellCalibration(deployed, shells, norm), truth


MAKERS: dict[type[CalibrationData], Callable[[int, np.random.Generator], Made]] = {
    PointCalibration: _points,
    HeldOutCalibration: _with_difficulty,
    SpreadCalibration: _with_spread(SpreadCalibration),
    PredictiveCalibration: _with_spread(PredictiveCalibration),
    QuantileCalibration: _quantiles,
    FoldCalibration: _refits(FoldCalibration),
    ResampleCalibration: _refits(ResampleCalibration),
    ShellCalibration: _shells,
}


def calibration_data(kind: type[Any], n: int = 88, seed: int = 0) -> tuple[Any, Array]:
    """Data of `n` calibration rows, and the true positions (n_new, n_coordinates) of the new rows."""
    return MAKERS[kind](n, np.random.default_rng(seed))
