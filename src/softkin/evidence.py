"""What the interval methods see, from the stored outputs of a dataset's models."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.bounds import read_bounds
from softkin.datasets.table import read_subset
from softkin.fitting import SPREAD, STANDARD_DEVIATION
from softkin.interface import (
    EXTRAPOLATION,
    TEST,
    TRAIN,
    VALIDATION,
    Array,
    Evidence,
    RefitEvidence,
    Samples,
    Shell,
    ShellEvidence,
)
from softkin.shells import CommandNorm

Run = tuple[str, str]
#: The subsets that get intervals; `new` rows of an evidence are theirs, in this order.
INTERVAL_SUBSETS = (TEST, EXTRAPOLATION)
#: What a method is `on` -> the columns of predictions that it needs, by what they start with.
PREFIXES = {"predictions": ("",), "predictive": (STANDARD_DEVIATION,), "spreads": (STANDARD_DEVIATION, SPREAD)}


class Evidences:
    """Stored outputs of one dataset: `predictions` and `quantiles` are (model, preset) -> file, `refits` and `shells`
    one file each.

    Of `table` the truth of `train` and `validation` is read, and commands.
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
    ) -> None:
        self.train = read_subset(table, TRAIN)
        self.validation = read_subset(table, VALIDATION)
        self.new_commands = {subset: read_subset(table, subset).commands for subset in INTERVAL_SUBSETS}
        self.levels = list(confidence_levels)
        self.predictions = {run: pd.read_parquet(path) for run, path in predictions.items()}
        self.quantiles = {run: pd.read_parquet(path) for run, path in quantiles.items()}
        self.refits, self.shells = read_archive(refits), read_archive(shells)

    def of(self, on: str) -> Iterator[tuple[Run, Evidence | RefitEvidence | ShellEvidence]]:
        """(model, preset) and evidence of every run that a method on `on` can be put around."""
        if on in ("folds", "resamples"):
            yield from self._refitted(on)
        elif on == "shells":
            yield from self._on_shells()
        elif on == "quantiles":
            for run, stored in self.quantiles.items():
                new = [read_bounds(stored, subset, self.levels) for subset in INTERVAL_SUBSETS]
                yield (
                    run,
                    Evidence(
                        read_bounds(stored, VALIDATION, self.levels),
                        self.validation.positions,
                        np.concatenate(new, axis=1),
                    ),
                )
        else:
            for run, stored in self.predictions.items():
                prefix = next((prefix for prefix in PREFIXES[on] if f"{prefix}m1_x" in stored), None)
                if prefix is not None:
                    yield run, self._predicted(stored, prefix)

    def by_subset(self, rows: Array, axis: int = 0) -> dict[str, Array]:
        """An array over the `new` rows, taken apart into test and extrapolation."""
        sizes = [len(self.new_commands[subset]) for subset in INTERVAL_SUBSETS]
        return dict(zip(INTERVAL_SUBSETS, np.split(rows, np.cumsum(sizes)[:-1], axis=axis), strict=True))

    def _predicted(self, stored: pd.DataFrame, prefix: str) -> Evidence:
        spreads: dict[str, Array] = {}
        if prefix:
            spreads = {
                "train_spread": predicted_rows(stored, [TRAIN], prefix),
                "calibration_spread": predicted_rows(stored, [VALIDATION], prefix),
                "new_spread": predicted_rows(stored, INTERVAL_SUBSETS, prefix),
            }
        return Evidence(
            predicted_rows(stored, [VALIDATION]),
            self.validation.positions,
            predicted_rows(stored, INTERVAL_SUBSETS),
            train_commands=self.train.commands,
            calibration_commands=self.validation.commands,
            new_commands=np.concatenate(list(self.new_commands.values())),
            **spreads,
        )

    def _on_shells(self) -> Iterator[tuple[Run, ShellEvidence]]:
        for run, shells in shells_of(self.shells, self.train).items():
            yield run, ShellEvidence(self._predicted(self.predictions[run], ""), shells, norm_of(self.shells))

    def _refitted(self, kind: str) -> Iterator[tuple[Run, RefitEvidence]]:
        n = len(self.train)
        for name in self.refits:
            model, _, rest = name.partition("/")
            preset, _, found = rest.partition("/")
            if found != kind:
                continue
            if kind == "folds":
                folds = self.refits["fold_of_row"]
                inside = [np.flatnonzero(folds != fold) for fold in range(int(folds.max()) + 1)]
            else:
                inside = list(self.refits["resample_rows"])
            everywhere = self.refits[name]
            yield (
                (model, preset),
                RefitEvidence(inside, everywhere[:, :n], self.train.positions, everywhere[:, n:]),
            )


def shells_of(archive: Mapping[str, Array], train: Samples) -> dict[Run, list[Shell]]:
    """The shells of each run in an archive of `refit_shells`, the smallest core first."""
    found: dict[Run, list[Shell]] = {}
    for name, predicted in archive.items():
        if name.count("/") != 2:  # what all runs share
            continue
        model, preset, place = name.split("/")
        core, shell = (archive[f"{part}_{place}"] for part in ("core", "shell"))
        commands, truth = train.commands, train.positions
        found.setdefault((model, preset), []).append(Shell(commands[core], commands[shell], predicted, truth[shell]))
    return found


def norm_of(archive: Mapping[str, Array]) -> Callable[[Array], Array]:
    """How far out commands (n_rows, n_commands) lie (n_rows,), by an archive of `refit_shells`."""
    return CommandNorm(archive["centre"], archive["scale"]).of


def read_archive(path: str | Path | None) -> dict[str, Array]:
    """The arrays of a file of `refit` or `refit_shells`; none where there is no file."""
    if path is None:
        return {}
    with np.load(path) as archive:
        return dict(archive)


def predicted_rows(stored: pd.DataFrame, subsets: Sequence[str], prefix: str = "") -> Array:
    """Predicted positions, or spreads with a `prefix`, (n_rows, n_coordinates), subset by subset."""
    parts = [stored[stored["subset"] == subset].filter(regex=rf"^{prefix}m\d+_[xyz]$") for subset in subsets]
    return np.concatenate([part.to_numpy() for part in parts])
