"""A dataset of a finished run as `benchmarks.peers` compares it: what a peer is given, and the scores of anybody."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from benchmarks.utilisation import jobs
from softkin.core.bounds import read_bounds
from softkin.core.metrics.interval import covered, winkler_scores
from softkin.core.metrics.point import mae_mm, rmse_mm
from softkin.core.runs import BOTH, SEARCHED, Run
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, VALIDATION, Array, informative_coordinates
from softkin.data.audit.gross_rows import gross_rows
from softkin.data.table import read_subset
from softkin.training.predict import predicted_rows
from softkin.training.selection import run_of_choice
from softkin.uncertainty.choose import deployed_choice
from softkin.uncertainty.conformal import around, conformal_limits

LEVEL, NEW = 0.9, (TEST, EXTRAPOLATION)


@dataclass(frozen=True)
class Dataset:
    """A dataset of a finished run, in the folder of its results."""

    folder: Path

    @cached_property
    def samples(self) -> dict[str, Any]:
        """Its rows by subset."""
        return {subset: read_subset(self.folder / "table.parquet", subset) for subset in SUBSETS}

    @cached_property
    def title(self) -> str:
        """Its title, with its rows that are gross errors."""
        gross = gross_rows(self.samples)
        n = {subset: int(gross[subset].sum()) for subset in NEW}
        bad = f"; gross errors: {n[TEST]} rows of test, {n[EXTRAPOLATION]} outside" if any(n.values()) else ""
        sizes = ", ".join(f"{len(self.samples[subset])} {subset}" for subset in SUBSETS)
        return f"{json.loads((self.folder / 'dataset.json').read_text())['dataset']} ({sizes}{bad})"

    def given(self) -> dict[str, Array]:
        """What a peer is given: moving coordinates of train, and all commands that it is asked for."""
        train = self.samples[TRAIN]
        asked = [self.samples[subset].commands for subset in (VALIDATION, *NEW)]
        return {"commands": train.commands, "positions": train.positions[:, self.moving], "asked": np.vstack(asked)}

    @cached_property
    def moving(self) -> Any:
        """Mask (n_coordinates,) of the coordinates that move on train."""
        return informative_coordinates(self.samples[TRAIN].positions)

    def scores(self, predicted: Array) -> dict[str, float]:
        """Of predictions (n_rows, n_moving) of validation, test and extrapolation, one below the other."""
        ends = np.cumsum([len(self.samples[subset]) for subset in (VALIDATION, TEST)])
        parts = dict(zip((VALIDATION, *NEW), np.split(predicted, ends), strict=True))
        truth = {subset: self.samples[subset].positions[:, self.moving] for subset in parts}
        half = conformal_limits(np.abs(truth[VALIDATION] - parts[VALIDATION]), [LEVEL])
        found: dict[str, float] = {}
        for subset in NEW:
            bounds = around(parts[subset], half[0])
            found |= {f"{subset}_rmse": rmse_mm(truth[subset], parts[subset])}
            found |= {f"{subset}_mae": mae_mm(truth[subset], parts[subset])}
            found |= _of_bounds(subset, truth[subset], bounds)
        return found

    @cached_property
    def jobs(self) -> pd.DataFrame:
        """Its jobs in that run, with the CPU seconds that each read off the system's clock."""
        run = jobs(self.folder.parent)
        return run[[self.folder.name in Path(job).parts for job in run["job"]]]

    def predicted(self, run: Run) -> Array:
        """What a run predicts, (n_rows, n_moving), of validation, test and extrapolation, one below the other."""
        stored = pd.read_parquet(self.folder / run.model / run.preset / "predictions.parquet")
        return predicted_rows(stored, (VALIDATION, *NEW))[:, self.moving]

    def cheapest(self, seconds: float) -> dict[str, Any] | None:
        """What softkin reaches with a budget: of the models whose searches and fits took least CPU time, together at
        most `seconds`, the run that its own rule chooses by their scores on train; None where one model takes more.
        """
        fits = self.jobs[self.jobs["rule"] == "fit_model"].sort_values("cpu_s", kind="stable")
        within = fits[fits["cpu_s"].cumsum() <= seconds]
        if within.empty:
            return None
        runs = [Run(Path(job).name, preset) for job in within["job"] for preset in SEARCHED]
        best = run_of_choice({run: self.folder / run.model / run.preset / "parameters.json" for run in runs}, BOTH)
        used = {"cpu_seconds": float(within["cpu_s"].sum())}
        title = f"softkin, its {len(within)} cheapest models: {best.model}, {best.preset}"
        return {"peer": title} | used | self.scores(self.predicted(best))

    def softkin(self) -> Iterator[dict[str, Any]]:
        """What softkin deployed, by the same split conformal step and by its own intervals."""
        choice = deployed_choice(self.folder / "interval_choice.csv")
        assert choice is not None
        scores = self.scores(self.predicted(Run(choice["model"], choice["preset"])))
        used = {"cpu_seconds": float(self.jobs["cpu_s"].sum())}
        yield {"peer": f"softkin: {choice['model']}, {choice['preset']}"} | used | scores
        own = pd.read_parquet(self.folder / "intervals" / f"{choice['outside']}.parquet")
        own = own[(own["model"] == choice["model"]) & (own["preset"] == choice["preset"])]
        for subset in NEW:
            bounds = read_bounds(own, subset, [LEVEL])[0][:, self.moving]
            scores |= _of_bounds(subset, self.samples[subset].positions[:, self.moving], bounds)
        yield {"peer": f"softkin, `{choice['outside']}`"} | used | scores


def _of_bounds(subset: str, truth: Array, bounds: Array) -> dict[str, float]:
    winkler = winkler_scores(truth, bounds, LEVEL)
    return {f"{subset}_coverage": float(covered(truth, bounds).mean()), f"{subset}_winkler": float(winkler.mean())}
