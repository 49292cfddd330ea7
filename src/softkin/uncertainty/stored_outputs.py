"""Stored outputs of a dataset's models, read as the calibration data that interval methods need."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.bounds import bounds_levels, read_bounds
from softkin.core.manifest import files_of_runs
from softkin.core.run_archive import RunArchive, read_run_archive
from softkin.core.runs import TUNED, Run
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, VALIDATION, Array, Samples
from softkin.core.shells import CommandNorm
from softkin.data.table import read_subset
from softkin.training.held_out import PartSettings
from softkin.training.predict import SPREAD, STANDARD_DEVIATION, predicted_rows, rows_with_spread
from softkin.training.refit import FOLD_OF_ROW, FOLDS, RESAMPLE_ROWS, RESAMPLES
from softkin.training.refit_shells import CENTRE, SCALE, core_rows, shell_rows
from softkin.training.selection import deployable_runs
from softkin.uncertainty.calibration_data import (
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
from softkin.uncertainty.held_out_difficulty import HeldOutDifficulty
from softkin.uncertainty.held_out_errors import difficulties
from softkin.uncertainty.intervals.spec import Data
from softkin.uncertainty.promise import calibration_set

#: The subsets that get intervals: the new rows of calibration data, in this order.
INTERVAL_SUBSETS = (TEST, EXTRAPOLATION)


class StoredOutputs:
    """Stored outputs of the models of one dataset.

    `validation` is the calibration set; where blocks are exchangeable and not rows, each counts alike there.
    `calibrated` numbers its rows in the table, and `promise` says what they promise.

    Parameters:
        table: the tidy table; true positions are read of `train` and `validation` only.
        predictions: run -> file of its predicted positions.
        quantiles: run -> file of its predicted quantiles.
        refits: the file of the rule `refit`; None: no run was refitted on folds and bootstrap samples.
        confidence_levels: nominal levels in (0, 1), ascending.
        shells: the file of the rule `refit_shells`; None: no run was refitted on cores of `train`.
        difficulties: run -> how hard commands are for it by its errors on held-out folds of `train`.
    """

    def __init__(
        self,
        table: str | Path,
        *,
        predictions: Mapping[Run, str | Path],
        quantiles: Mapping[Run, str | Path],
        refits: str | Path | None,
        confidence_levels: Sequence[float],
        shells: str | Path | None = None,
        difficulties: Mapping[Run, HeldOutDifficulty] | None = None,
    ) -> None:
        self.train = read_subset(table, TRAIN)
        self.validation, self.calibrated, self.promise = calibration_set(read_subset(table, VALIDATION))
        self.new_commands = {subset: read_subset(table, subset).commands for subset in INTERVAL_SUBSETS}
        self.levels = list(confidence_levels)
        self.predictions = {run: pd.read_parquet(path) for run, path in predictions.items()}
        self.quantiles = {run: pd.read_parquet(path) for run, path in quantiles.items()}
        self.difficulties = difficulties or {}
        self.refits, self.shells = read_run_archive(refits), read_run_archive(shells)

    def of(self, kind: type[Data]) -> Iterator[tuple[Run, Data]]:
        """Runs that have stored outputs of this kind, each with its calibration data."""
        readers: dict[type[Any], Callable[[], Iterator[tuple[Run, Any]]]] = {
            PointCalibration: self._points,
            SpreadCalibration: lambda: self._spreads(SpreadCalibration, STANDARD_DEVIATION, SPREAD),
            PredictiveCalibration: lambda: self._spreads(PredictiveCalibration, STANDARD_DEVIATION),
            QuantileCalibration: self._quantiles,
            FoldCalibration: self._folds,
            ResampleCalibration: self._resamples,
            ShellCalibration: self._shells,
            HeldOutCalibration: self._held_out,
        }
        return readers[kind]()

    def by_subset(self, rows: Array, axis: int = 0) -> dict[str, Array]:
        """An array over the new rows, split into test and extrapolation along `axis`."""
        sizes = [len(self.new_commands[subset]) for subset in INTERVAL_SUBSETS]
        return dict(zip(INTERVAL_SUBSETS, np.split(rows, np.cumsum(sizes)[:-1], axis=axis), strict=True))

    def _points(self) -> Iterator[tuple[Run, PointCalibration]]:
        for run in self.predictions:
            yield run, PointCalibration(**self._predicted(run))

    def _spreads(self, kind: type[SpreadCalibration], *prefixes: str) -> Iterator[tuple[Run, SpreadCalibration]]:
        for run, stored in self.predictions.items():
            prefix = next((prefix for prefix in prefixes if f"{prefix}m1_x" in stored), None)
            if prefix is not None:
                yield (
                    run,
                    kind(
                        **self._predicted(run),
                        train_spread=predicted_rows(stored, [TRAIN], prefix)[rows_with_spread(len(self.train))],
                        calibration_spread=predicted_rows(stored, [VALIDATION], prefix)[self.calibrated],
                        new_spread=predicted_rows(stored, INTERVAL_SUBSETS, prefix),
                    ),
                )

    def _held_out(self) -> Iterator[tuple[Run, HeldOutCalibration]]:
        for run in self.predictions:
            if run in self.difficulties:
                yield run, HeldOutCalibration(**self._predicted(run), difficulty=self.difficulties[run])

    def _predicted(self, run: Run) -> dict[str, Array]:
        stored = self.predictions[run]
        return {
            "calibration": predicted_rows(stored, [VALIDATION])[self.calibrated],
            "truth": self.validation.positions,
            "new": predicted_rows(stored, INTERVAL_SUBSETS),
            "train_commands": self.train.commands,
            "calibration_commands": self.validation.commands,
            "new_commands": np.concatenate(list(self.new_commands.values())),
        }

    def _quantiles(self) -> Iterator[tuple[Run, QuantileCalibration]]:
        for run, stored in self.quantiles.items():
            levels = bounds_levels(stored)
            calibration = read_bounds(stored, VALIDATION, levels)[:, self.calibrated]
            new = [read_bounds(stored, subset, levels) for subset in INTERVAL_SUBSETS]
            yield run, QuantileCalibration(calibration, self.validation.positions, np.concatenate(new, axis=1), levels)

    def _folds(self) -> Iterator[tuple[Run, FoldCalibration]]:
        if self.refits.of_runs:
            fold_of_row = self.refits.shared[FOLD_OF_ROW]
            fitted_rows = [np.flatnonzero(fold_of_row != fold) for fold in range(int(fold_of_row.max()) + 1)]
            for run, train, new in self._refitted(FOLDS):
                yield run, FoldCalibration(fitted_rows, train, self.train.positions, new)

    def _resamples(self) -> Iterator[tuple[Run, ResampleCalibration]]:
        for run, train, new in self._refitted(RESAMPLES):
            fitted_rows = list(self.refits.shared[RESAMPLE_ROWS])
            yield run, ResampleCalibration(fitted_rows, train, self.train.positions, new)

    def _refitted(self, kind: str) -> Iterator[tuple[Run, Array, Array]]:
        """Runs with the predictions of their refits on `train` and on the new rows."""
        for (run, part), predicted in self.refits.of_runs.items():
            if part == kind:
                yield run, predicted[:, : len(self.train)], predicted[:, len(self.train) :]

    def _shells(self) -> Iterator[tuple[Run, ShellCalibration]]:
        for run, shells in shells_of(self.shells, self.train).items():
            yield run, ShellCalibration(PointCalibration(**self._predicted(run)), shells, norm_of(self.shells))


def stored_outputs(files: Any, params: Any) -> StoredOutputs:
    """The stored outputs named by the inputs `files` and the `params` of a rule for intervals."""
    return StoredOutputs(
        files.table,
        predictions=files_of_runs(files.models, params.runs, "predictions.parquet"),
        quantiles=files_of_runs(files.quantile_models, params.quantile_runs, "quantiles.parquet"),
        refits=next(iter(files.refits), None),
        shells=next(iter(files.shells), None),
        confidence_levels=params.confidence_levels,
        difficulties=_difficulties(files, params),
    )


def _difficulties(files: Any, params: Any) -> dict[Run, HeldOutDifficulty]:
    """Of the searched runs of a rule that can be deployed; {} where no method asks for them."""
    if params.study_parts is None:
        return {}
    parameters = files_of_runs(files.models, params.searched, "parameters.json")
    runs = deployable_runs([], parameters, params.objective)
    return difficulties(
        read_subset(files.table, TRAIN),
        PartSettings(**params.study_parts, core_shares=(), scores={TUNED}, seed=params.seed),
        files_of_runs(files.models, params.pool, "held_out.npz"),
        files_of_runs(files.models, runs, "fit.json"),
    )


def shells_of(archive: RunArchive, train: Samples) -> dict[Run, list[Shell]]:
    """Shells of each run in an archive of `refit_shells`, the smallest core first."""
    shells: dict[Run, list[Shell]] = {}
    for (run, place), predicted in archive.of_runs.items():
        core, shell = archive.shared[core_rows(place)], archive.shared[shell_rows(place)]
        commands, truth = train.commands, train.positions
        shells.setdefault(run, []).append(Shell(commands[core], commands[shell], predicted, truth[shell]))
    return shells


def norm_of(archive: RunArchive) -> Callable[[Array], Array]:
    """Command norm, (n_rows, n_commands) -> (n_rows,), stored in an archive of `refit_shells`."""
    return CommandNorm(archive.shared[CENTRE], archive.shared[SCALE]).of
