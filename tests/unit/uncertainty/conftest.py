"""Made-up calibration data, and the stored outputs of one made-up run."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import fields
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.run_archive import RunArchive
from softkin.core.runs import Run
from softkin.core.samples import Array
from softkin.data.table import read_subset
from softkin.uncertainty.calibration_data import (
    CalibrationData,
    FoldCalibration,
    HeldOutCalibration,
    PointCalibration,
    PredictiveCalibration,
    QuantileCalibration,
    ResampleCalibration,
    Shell,
    ShellCalibration,
    SpreadCalibration,
)
from softkin.uncertainty.held_out_difficulty import fit_difficulty
from softkin.uncertainty.stored_outputs import StoredOutputs

LEVELS = (0.8, 0.9, 0.95)
N_COORDINATES, N_NEW = 6, 40
RUN = Run("mlp", "paper")


def rank(n: int, level: float) -> int:
    return math.ceil(Fraction(str(level)) * (n + 1))


def global_random_state() -> Array:
    state = np.random.get_state()
    assert isinstance(state, tuple)
    return np.array(state[1])


def norm(rows: Array) -> Array:
    return np.asarray(np.linalg.norm(rows, axis=1))


def around_point(calibration: Array, truth: Array, new: Array) -> PointCalibration:
    """For methods that look at no commands."""
    return PointCalibration(calibration, truth, new, *(np.zeros((rows, 2)) for rows in (50, len(truth), len(new))))


def point_calibration(
    n: int, n_coordinates: int = N_COORDINATES, n_new: int = N_NEW, seed: int = 0
) -> PointCalibration:
    rng = np.random.default_rng(seed)
    truth = rng.standard_normal((n, n_coordinates)) * 10
    scale = np.arange(1, n_coordinates + 1)
    predicted = truth + rng.standard_t(3, truth.shape) * scale
    return around_point(predicted, truth, rng.standard_normal((n_new, n_coordinates)) * 10)


def quantile_calibration(n: int, seed: int = 0) -> QuantileCalibration:
    base = point_calibration(n, seed=seed)
    half = np.array([1.0, 1.5, 2.0])[:, None, None]
    calibration, new = (np.stack([c - half, c + half], axis=-1) for c in (base.calibration, base.new))
    return QuantileCalibration(calibration, base.truth, new, LEVELS)


def spread_calibration(
    n: int, n_coordinates: int = N_COORDINATES, n_new: int = N_NEW, seed: int = 0
) -> PredictiveCalibration:
    """With commands and a spread that have nothing to do with the errors."""
    base, rng = point_calibration(n, n_coordinates, n_new, seed), np.random.default_rng(seed + 1)
    train, calibration, new = (rng.uniform(0.5, 2.0, (rows, n_coordinates)) for rows in (50, n, n_new))
    commands = [rng.standard_normal((rows, 2)) for rows in (50, n, n_new)]
    points = PointCalibration(base.calibration, base.truth, base.new, *commands)
    return PredictiveCalibration(**vars(points), train_spread=train, calibration_spread=calibration, new_spread=new)


def held_out_calibration(n: int, seed: int = 0) -> HeldOutCalibration:
    """Errors on held-out rows grow tenfold along the first command, and those of the calibration set do not."""
    rng = np.random.default_rng(seed)
    commands, given = rng.uniform(-1, 1, (200, 2)), spread_calibration(n, seed=seed)
    errors = np.abs(rng.standard_normal((200, N_COORDINATES))) * 10 ** commands[:, :1]
    points = {field.name: getattr(given, field.name) for field in fields(PointCalibration)}
    return HeldOutCalibration(**points, difficulty=fit_difficulty(commands, errors, np.arange(N_COORDINATES)))


def fold_calibration(n: int, seed: int = 0) -> FoldCalibration:
    rng = np.random.default_rng(seed)
    truth = rng.standard_normal((n, N_COORDINATES)) * 10
    fold_of_row = rng.permutation(np.arange(n) % 5)
    fitted_rows = [np.flatnonzero(fold_of_row != fold) for fold in range(5)]
    train = truth + rng.standard_t(3, (5, n, N_COORDINATES))
    return FoldCalibration(fitted_rows, train, truth, rng.standard_normal((5, N_NEW, N_COORDINATES)) * 10)


def resample_calibration(n: int, seed: int = 0) -> ResampleCalibration:
    rng = np.random.default_rng(seed)
    truth = rng.standard_normal((n, N_COORDINATES)) * 10
    fitted_rows = list(rng.integers(n, size=(30, n)))
    train = truth + rng.standard_t(3, (30, n, N_COORDINATES))
    return ResampleCalibration(fitted_rows, train, truth, rng.standard_normal((30, N_NEW, N_COORDINATES)) * 10)


def shell_calibration(n: int, seed: int = 0) -> ShellCalibration:
    """Cores of norms up to 0.5, 0.7 and 0.85; errors grow with the norm. The second half of `new` is far out."""
    rng = np.random.default_rng(seed)
    train = rng.uniform(-1, 1, (300, 2))
    norms = norm(train)
    near = rng.uniform(-0.5, 0.5, (N_NEW // 2, 2))
    far = near * 1.5 / norm(near)[:, None]
    base = point_calibration(n, seed=seed)
    commands = (train, rng.uniform(-1, 1, (n, 2)), np.concatenate([near, far]))
    deployed = PointCalibration(base.calibration, base.truth, base.new, *commands)
    shells = []
    for radius in (0.5, 0.7, 0.85):
        shell = train[norms > radius]
        truth = rng.standard_normal((len(shell), N_COORDINATES))
        errors = rng.standard_normal(truth.shape) * norm(shell)[:, None] ** 2
        shells.append(Shell(train[norms <= radius], shell, truth + errors, truth))
    return ShellCalibration(deployed, shells, norm)


MAKERS: dict[type[CalibrationData], Callable[[int], Any]] = {
    PointCalibration: spread_calibration,
    HeldOutCalibration: held_out_calibration,
    SpreadCalibration: spread_calibration,
    PredictiveCalibration: spread_calibration,
    QuantileCalibration: quantile_calibration,
    FoldCalibration: fold_calibration,
    ResampleCalibration: resample_calibration,
    ShellCalibration: shell_calibration,
}


def split_conformal_by_hand(data: PointCalibration) -> Array:
    scores = np.sort(np.abs(data.truth - data.calibration), axis=0)
    levels = []
    for level in LEVELS:
        half = scores[rank(len(scores), level) - 1]
        levels.append(np.stack([data.new - half, data.new + half], axis=-1))
    return np.stack(levels)


STORED_LEVELS = [0.8, 0.9]


def stored_outputs_of(table: Path, folder: Path) -> StoredOutputs:
    train, errors = read_subset(table, "train"), np.random.default_rng(0).exponential(size=(40, 3))
    return StoredOutputs(
        table,
        predictions={RUN: folder / "predictions.parquet"},
        quantiles={RUN: folder / "quantiles.parquet"},
        refits=folder / "refits.npz",
        confidence_levels=STORED_LEVELS,
        shells=folder / "shells.npz",
        difficulties={RUN: fit_difficulty(train.commands, errors, np.arange(3))},
    )


@pytest.fixture
def stored(table: Path, tmp_path: Path) -> Path:
    """Folder of predictions one mm off in x, all of them sure to 2 mm; quantiles two mm around the truth."""
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    predictions["m1_x"] += 1.0
    for coordinate in ("m1_x", "m1_y", "m1_z"):
        predictions[f"std_{coordinate}"] = 2.0
    predictions.to_parquet(tmp_path / "predictions.parquet")
    frames = []
    for subset in ("validation", "test", "extrapolation"):
        true = read_subset(table, subset).positions
        frames += [bounds_frame(np.stack([true - 2, true + 2], axis=-1), subset, level) for level in STORED_LEVELS]
    pd.concat(frames).to_parquet(tmp_path / "quantiles.parquet")
    refits_of(table).write(tmp_path / "refits.npz")
    shells_of_two_cores(table).write(tmp_path / "shells.npz")
    return tmp_path


def refits_of(table: Path) -> RunArchive:
    """Refits on 4 folds and on 30 bootstrap samples, each off by about a mm everywhere."""
    truth = [read_subset(table, subset).positions for subset in ("train", "test", "extrapolation")]
    rng = np.random.default_rng(0)
    fold = np.arange(len(truth[0])) % 4
    return RunArchive(
        {"fold_of_row": fold, "resample_rows": rng.integers(len(fold), size=(30, len(fold)))},
        {
            (RUN, "folds"): np.concatenate(truth)[None] + rng.standard_normal((4, 1, 3)),
            (RUN, "resamples"): np.concatenate(truth)[None] + rng.standard_normal((30, 1, 3)),
        },
    )


def shells_of_two_cores(table: Path) -> RunArchive:
    """Refits on the inner 40 % and 50 % of `train`, one to two mm off beyond them."""
    train, rng = read_subset(table, "train"), np.random.default_rng(1)
    norms = norm(train.commands)
    shared: dict[str, Any] = {"centre": np.zeros(2), "scale": np.ones(2)}
    of_runs = {}
    for place, radius in enumerate(np.quantile(norms, [0.4, 0.5])):
        shell = np.flatnonzero(norms > radius)
        shared |= {f"core_{place}": np.flatnonzero(norms <= radius), f"shell_{place}": shell}
        of_runs[RUN, str(place)] = train.positions[shell] + rng.uniform(1, 2, (len(shell), 3))
    return RunArchive(shared, of_runs)


def garbled(table: Path, subsets: Sequence[str], output: Path) -> Path:
    """The table with the true positions of these subsets replaced by garbage."""
    frame = pd.read_parquet(table)
    positions = frame.filter(regex=r"^m\d+_[xyz]$").columns
    rows = frame["subset"].isin(subsets)
    frame.loc[rows, positions] = 1e6 - frame.loc[rows, positions]
    frame.to_parquet(output, index=False)
    return output


def shells_with_growing_errors(core_exponent: float, slope: float, new: Array, seed: int = 0) -> ShellCalibration:
    """Errors that follow an error-growth model, the second coordinate three times those of the first."""
    rng = np.random.default_rng(seed)
    train = rng.uniform(-1, 1, (600, 2))
    norms = norm(train)
    shells = []
    for radius in (0.5, 0.7, 0.9):
        core, commands = train[norms <= radius], train[norms > radius]
        core_radius = norm(core).max() / norms.max()
        size = core_radius**core_exponent * (norm(commands) / norm(core).max()) ** slope
        errors = rng.standard_normal((len(commands), 2)) * size[:, None] * [1.0, 3.0]
        shells.append(Shell(core, commands, errors, np.zeros_like(errors)))
    return ShellCalibration(deployed_at(train, new), shells, norm)


def deployed_at(train: Array, new: Array) -> PointCalibration:
    """A model of two coordinates that are 0 everywhere."""
    calibration, predicted = np.zeros((50, 2)), np.zeros((len(new), 2))
    return PointCalibration(calibration, calibration, predicted, train, np.zeros((50, 2)), new)
