"""Fit an ensemble: weights of a dataset's searched runs, picked on `train` alone, and their weighted mean.

Weights are picked by what each run predicts of rows of `train` that were held out of its fit: those of the folds for
the preset `tuned`, those of the outer shells for `outer`. These predictions are stored, and so are the fitted models:
no model is fitted here.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd

from softkin.core.clocks import stopwatch
from softkin.core.csv_tables import write_csv
from softkin.core.files import read_json, replacing, write_json
from softkin.core.job_records import load_model
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, TRAIN, Array
from softkin.data.table import read_subset
from softkin.models.ensembles.spec import EnsembleSpec
from softkin.models.estimators.memory_features import MEMORIES
from softkin.models.estimators.weighted_mean import weighted_mean, weighted_sum
from softkin.training.held_out import SCORES, PartSettings, Robot, mean_error, parts_of, read_held_out, truth_of
from softkin.training.members import Weights, as_records
from softkin.training.predict import predict, predicted_rows

logger = logging.getLogger("softkin")


@dataclass(frozen=True, slots=True)
class MemberFiles:
    """Files of a searched run: the fitted `model`, the `record` of its fit, what it predicts of rows `held_out`, its
    `predictions` of every subset.
    """

    model: Path
    record: Path
    held_out: Path
    predictions: Path


@dataclass(frozen=True, slots=True)
class EnsembleFiles:
    """Files of an ensemble, as of any searched run: the `model` (joblib), a `record` (JSON), the `predictions`
    (Parquet), the `parameters`, which are its weights (JSON), and the `trials`, its steps (CSV).
    """

    model: str | Path
    record: str | Path
    predictions: str | Path
    parameters: str | Path
    trials: str | Path


@dataclass(frozen=True, slots=True)
class Steps:
    """The weights that an ensemble tries, runs of weight 0 left out, and the errors (mm) of each, part by part."""

    weights: Sequence[Weights]
    errors: Sequence[Sequence[float]]

    @property
    def best(self) -> Weights:
        """Those of the lowest mean of errors."""
        return self.weights[int(np.argmin([np.mean(of_step) for of_step in self.errors]))]


class Pool:
    """What the runs of a dataset predict of the rows of `train` that they are scored on, by preset and part.

    Parameters:
        truth: preset -> true positions (n_scored, n_moving) in mm of the rows of each part.
        predicted: run -> preset -> predictions of the same rows, all parts one below the other.
    """

    def __init__(self, truth: Mapping[str, Sequence[Array]], predicted: Mapping[Run, Mapping[str, Array]]) -> None:
        ends = {by: np.cumsum([len(part) for part in parts])[:-1] for by, parts in truth.items()}
        self.truth = truth
        self.predicted = {
            run: {by: np.split(stored[by], ends[by]) for by in stored} for run, stored in predicted.items()
        }

    def error(self, weights: Weights, by: str, part: int) -> float:
        """Error (mm) of a weighted mean of runs on a part; infinite where one of the runs has no predictions."""
        if not all(by in self.predicted[run] for run in weights):
            return float("inf")
        mean = weighted_sum([self.predicted[run][by][part] for run in weights], list(weights.values()))
        return mean_error(mean, self.truth[by][part])

    def score(self, weights: Weights, by: str) -> float:
        """The mean of the errors on all parts."""
        return float(np.mean([self.error(weights, by, part) for part in range(len(self.truth[by]))]))

    def steps(self, spec: EnsembleSpec, by: str, parts: Sequence[int]) -> Steps:
        """The steps of an ensemble on some of the parts, each of which counts the same."""
        runs = [run for run, stored in self.predicted.items() if by in stored]
        truth = [self.truth[by][part] for part in parts]
        tried = spec.steps(
            np.stack([np.concatenate([self.predicted[run][by][part] for part in parts]) for run in runs]),
            np.concatenate(truth),
            np.concatenate([np.full(len(rows), 1 / len(parts) / len(rows)) for rows in truth]),
        )
        weights = [{run: float(w) for run, w in zip(runs, step, strict=True) if w > 0} for step in tried]
        return Steps(weights, [[self.error(of_step, by, part) for part in parts] for of_step in weights])

    def left_out_score(self, spec: EnsembleSpec, by: str) -> float:
        """The mean of the errors on all parts, each of weights that are picked on the others: an error on the rows that
        weights were picked on would flatter. Of one part alone there is no other.
        """
        places = range(len(self.truth[by]))
        others = [[other for other in places if other != part] or [part] for part in places]
        return float(
            np.mean([self.error(self.steps(spec, by, of_part).best, by, part) for part, of_part in enumerate(others)])
        )


def fit_ensemble(
    table: str | Path,
    *,
    spec: EnsembleSpec,
    robot: Robot,
    settings: PartSettings,
    members: Mapping[Run, MemberFiles],
    files: Mapping[str, EnsembleFiles],
    threads: int,
) -> None:
    """Weight the searched runs of a dataset by each preset; write the weighted mean of the fitted models, what it
    predicts, and a record of both.

    Parameters:
        table: path of the tidy table (Parquet), of which the weights see `train` alone.
        spec: how runs are weighted.
        robot: base and command norm.
        settings: the parts of `train` that the runs were scored on.
        members: files of each run that may be a member.
        files: files of the ensemble of each preset.
        threads: threads at most.
    """
    rows, parts = parts_of(read_subset(table, TRAIN), settings, robot)
    truth = {by: truth_of(rows, of_preset) for by, of_preset in parts.items()}
    pool = Pool(truth, {run: read_held_out(of_run.held_out) for run, of_run in members.items()})
    for preset, of_preset in files.items():
        with stopwatch() as watch:
            steps = pool.steps(spec, preset, range(len(truth[preset])))
            picked_on = pool.left_out_score(spec, preset)
        best = steps.best
        records = {run: read_json(members[run].record) for run in best}
        about = described(best, records)
        scores = {SCORES[by]: picked_on if by == preset else pool.score(best, by) for by in parts}
        finite = {name: score if np.isfinite(score) else None for name, score in scores.items()}
        study = {"n_trials": len(steps.weights), "n_pruned": 0, "cpu_seconds": watch.cpu_seconds}
        write_json(of_preset.parameters, about | finite | study)
        write_steps(steps, of_preset.trials)
        models, names = [load_model(members[run].model) for run in best], [" ".join(run) for run in best]
        estimator = weighted_mean(models, list(best.values()), names)
        with replacing(of_preset.model) as temporary:
            joblib.dump(estimator, temporary, compress=3)
        microseconds = predict(
            table,
            spec=spec,
            estimator=estimator,
            threads=threads,
            predictions=of_preset.predictions,
            known=mean_predictions({members[run].predictions: weight for run, weight in best.items()}),
        )
        write_json(of_preset.record, about | sums(records) | {"predict_us_per_row": microseconds})
        logger.info("preset %s: %s", preset, ", ".join(f"{name} {w:.3g}" for name, w in about["params"].items()))


def mean_predictions(weights: Mapping[Path, float]) -> dict[str, Array]:
    """Subset -> the weighted mean (n_rows, n_coordinates) in mm of stored predictions (Parquet), by their weights: to
    the bit what the mean of the models predicts.
    """
    stored = [pd.read_parquet(path) for path in weights]
    return {
        subset: weighted_sum([predicted_rows(frame, [subset]) for frame in stored], list(weights.values()))
        for subset in SUBSETS
    }


def described(weights: Weights, records: Mapping[Run, Mapping[str, Any]]) -> dict[str, Any]:
    """What an ensemble's files say of it, as those of any run; the target space is one where all members have it, and
    the memory that of the member that is told most.
    """
    spaces = list(dict.fromkeys(record["target_space"] for record in records.values()))
    memories = [record["memory"] for record in records.values() if record["memory"] is not None]
    return {
        "target_space": " and ".join(spaces),
        "memory": max(memories, key=lambda memory: MEMORIES.index(memory["memory"])) if memories else None,
        "params": {"/".join(run): weight for run, weight in weights.items()},
        "members": as_records(weights),
    }


def sums(records: Mapping[Run, Mapping[str, Any]]) -> dict[str, Any]:
    """What the fits of all members took together."""
    of_members = list(records.values())
    names = ("solvers_at_iteration_bound", "fit_seconds", "fit_cpu_seconds")
    return {
        "skip_constant": True,
        "base": of_members[0]["base"],
        "n_train": max(record["n_train"] for record in of_members),
        **{name: sum(record[name] for record in of_members) for name in names},
    }


def write_steps(steps: Steps, trials: str | Path) -> None:
    """Write the steps as the trials of a study are written: trial, state, score_mm, first_part_mm, n_parts_scored, and
    the `weights` of the members.
    """
    rows = [
        {
            "trial": step,
            "state": "COMPLETE",
            "score_mm": float(np.mean(errors)),
            "first_part_mm": errors[0],
            "n_parts_scored": len(errors),
            "weights": " ".join(f"{'/'.join(run)}={weight:.4g}" for run, weight in weights.items()),
        }
        for step, (weights, errors) in enumerate(zip(steps.weights, steps.errors, strict=True))
    ]
    write_csv(trials, pd.DataFrame(rows))
