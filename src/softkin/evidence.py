"""What the interval methods see, from the stored outputs of a dataset's models."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.bounds import read_bounds
from softkin.datasets.table import read_subset
from softkin.fitting import SPREAD, STANDARD_DEVIATION
from softkin.interface import EXTRAPOLATION, TEST, TRAIN, VALIDATION, Array, Evidence, RefitEvidence

Run = tuple[str, str]
#: The subsets that get intervals; `new` rows of an evidence are theirs, in this order.
INTERVAL_SUBSETS = (TEST, EXTRAPOLATION)
#: What a method is `on` -> the columns of predictions that it needs, by what they start with.
PREFIXES = {"predictions": ("",), "predictive": (STANDARD_DEVIATION,), "spreads": (STANDARD_DEVIATION, SPREAD)}


class Evidences:
    """Stored outputs of one dataset: `predictions` and `quantiles` are (model, preset) -> file, `refits` one file.

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
    ) -> None:
        self.train = read_subset(table, TRAIN)
        self.validation = read_subset(table, VALIDATION)
        self.new_commands = {subset: read_subset(table, subset).commands for subset in INTERVAL_SUBSETS}
        self.levels = list(confidence_levels)
        self.predictions = {run: pd.read_parquet(path) for run, path in predictions.items()}
        self.quantiles = {run: pd.read_parquet(path) for run, path in quantiles.items()}
        self.refits: dict[str, Array] = {}
        if refits is not None:
            with np.load(refits) as archive:
                self.refits = dict(archive)

    def of(self, on: str) -> Iterator[tuple[Run, Evidence | RefitEvidence]]:
        """(model, preset) and evidence of every run that a method on `on` can be put around."""
        if on in ("folds", "resamples"):
            yield from self._refitted(on)
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
            wanted = {
                "predictions": ("",),
                "predictive": (STANDARD_DEVIATION,),
                "spreads": (STANDARD_DEVIATION, SPREAD),
            }
            for run, stored in self.predictions.items():
                prefix = next((prefix for prefix in wanted[on] if f"{prefix}m1_x" in stored), None)
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


def predicted_rows(stored: pd.DataFrame, subsets: Sequence[str], prefix: str = "") -> Array:
    """Predicted positions, or spreads with a `prefix`, (n_rows, n_coordinates), subset by subset."""
    parts = [stored[stored["subset"] == subset].filter(regex=rf"^{prefix}m\d+_[xyz]$") for subset in subsets]
    return np.concatenate([part.to_numpy() for part in parts])
