"""Score intervals in extrapolation, each beside the oracle: the extrapolation_intervals.csv of one dataset."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.bounds import read_bounds
from softkin.core.files import replacing
from softkin.core.metrics.interval import covered, widths, winkler_scores
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, TEST, TRAIN, VALIDATION, Array, Samples, informative_coordinates
from softkin.core.shells import command_norm
from softkin.data.table import read_subset
from softkin.uncertainty.intervals.spec import NO_GUARANTEE, IntervalMethod
from softkin.uncertainty.labelled.spec import NO_LABELS, Labelled, LabelledMethod
from softkin.uncertainty.stored_outputs import INTERVAL_SUBSETS, predicted_rows

COLUMNS = [
    *("dataset", "model", "preset", "interval_method", "confidence_level", "subset", "n_rows", "coverage"),
    *("joint_coverage", "mean_width_mm", "winkler_mm", "oracle_winkler_mm", "winkler_ratio_to_oracle"),
    *("infinite_share", "guarantee", "labels_used", "domain_auc", "effective_size", "refused"),
]


@dataclass(frozen=True)
class ScoredRun:
    """One run on one subset: the input of labelled methods, and the true positions (n_rows, n_coordinates) in mm."""

    run: Run
    subset: str
    labelled: Labelled
    true: Array
    moving: NDArray[np.bool_]


@dataclass(frozen=True)
class ExtrapolationMethods:
    """The interval `methods` with their stored `intervals` (method -> file), and the `labelled` methods, the oracle
    first, drawn with `seed`; all at the same confidence levels.
    """

    methods: Mapping[str, IntervalMethod[Any]]
    intervals: Mapping[str, str | Path]
    labelled: Mapping[str, LabelledMethod]
    confidence_levels: Sequence[float]
    seed: int


def score_extrapolation(
    table: str | Path,
    *,
    dataset: str,
    standardised_norm: bool,
    methods: ExtrapolationMethods,
    predictions: Mapping[Run, str | Path],
    runs: Collection[Run],
    output: str | Path,
) -> None:
    """Write a row per run, method, level and subset (test, extrapolation): means over moving coordinates.

    Rows are of the interval methods around the run, and of the labelled ones. Where a method refuses, it has no scores.

    Parameters:
        table: the tidy table.
        dataset: its name.
        standardised_norm: whether the command norm is that of standardised commands.
        methods: interval methods and labelled methods.
        predictions: run -> file of its predicted positions.
        runs: the runs that are scored.
        output: the scores (CSV).
    """
    samples = {subset: read_subset(table, subset) for subset in SUBSETS}
    norm = command_norm(samples[TRAIN].commands, standardised=standardised_norm).of
    stored = {name: pd.read_parquet(path) for name, path in methods.intervals.items()}
    rows: list[dict[str, Any]] = []
    for run in runs:
        for scored in _scored_runs(run, pd.read_parquet(predictions[run]), samples, norm):
            key = {"dataset": dataset, "model": run.model, "preset": run.preset, "subset": scored.subset}
            rows += [key | row for row in _labelled_rows(scored, methods)]
            rows += [key | row for row in _interval_rows(scored, methods, stored)]
    frame = pd.DataFrame(rows, columns=COLUMNS)
    frame["oracle_winkler_mm"] = _oracle(frame, next(iter(methods.labelled)))
    frame["winkler_ratio_to_oracle"] = frame["winkler_mm"] / frame["oracle_winkler_mm"]
    with replacing(output) as temporary:
        frame.to_csv(temporary, index=False)


def _scored_runs(
    run: Run, predictions: pd.DataFrame, samples: Mapping[str, Samples], norm: Callable[[Array], Array]
) -> Iterator[ScoredRun]:
    """The run on test and on extrapolation."""
    moving = informative_coordinates(samples[TRAIN].positions)
    errors = {
        subset: (rows.positions - predicted_rows(predictions, [subset]))[:, moving] for subset, rows in samples.items()
    }
    for subset in INTERVAL_SUBSETS:
        labelled = Labelled(
            samples[TRAIN].commands,
            samples[VALIDATION].commands,
            errors[VALIDATION],
            samples[subset].commands,
            errors[subset],
            norm,
        )
        yield ScoredRun(run, subset, labelled, samples[subset].positions, moving)


def _labelled_rows(scored: ScoredRun, methods: ExtrapolationMethods) -> Iterator[dict[str, Any]]:
    """Rows of the labelled methods."""
    levels = methods.confidence_levels
    for name, method in methods.labelled.items():
        answer = method.answer(scored.labelled, levels, methods.seed)
        errors = scored.labelled.errors[answer.scored]
        for level, half, refused in zip(levels, answer.half_widths, answer.refused, strict=True):
            row: dict[str, Any] = {"interval_method": name, "confidence_level": level, **answer.details}
            row |= {"guarantee": method.guarantee, "labels_used": method.labels, "refused": refused}
            bounds = np.stack([-half, half], axis=-1)
            infinite = {"n_rows": len(errors), "infinite_share": np.isinf(half).mean() if half.size else np.nan}
            yield row | (infinite if refused else scores(errors, bounds, level))


def _interval_rows(
    scored: ScoredRun, methods: ExtrapolationMethods, stored: Mapping[str, pd.DataFrame]
) -> Iterator[dict[str, Any]]:
    """Rows of the interval methods around this run; those calibrated on quantiles are around no point model."""
    levels, moving = methods.confidence_levels, scored.moving
    for name, method in methods.methods.items():
        frame = stored[name]
        frame = frame[(frame["model"] == scored.run.model) & (frame["preset"] == scored.run.preset)]
        if frame.empty or not method.calibrated_on.is_around_a_model:
            continue
        guarantee = method.guarantee if scored.subset == TEST else NO_GUARANTEE
        row = {"interval_method": name, "guarantee": guarantee, "labels_used": NO_LABELS, "refused": ""}
        for level, bounds in zip(levels, read_bounds(frame, scored.subset, levels), strict=True):
            of_level = scores(scored.true[:, moving], bounds[:, moving], level)
            yield row | {"confidence_level": level, **of_level}


def scores(true: Array, bounds: Array, level: float) -> dict[str, float]:
    """Scores of intervals (n_rows, n_coordinates, 2) in mm, over all rows and coordinates."""
    is_covered, width = covered(true, bounds), widths(bounds)
    return {
        "n_rows": len(true),
        "coverage": is_covered.mean(),
        "joint_coverage": is_covered.all(axis=1).mean(),
        "mean_width_mm": width.mean(),
        "winkler_mm": winkler_scores(true, bounds, level).mean(),
        "infinite_share": np.isinf(width).mean(),
    }


def _oracle(frame: pd.DataFrame, name: str) -> pd.Series:
    """Winkler score of the oracle for the run, level and subset of each row."""
    key = ["model", "preset", "confidence_level", "subset"]
    known = frame[frame["interval_method"] == name].set_index(key)["winkler_mm"]
    return pd.Series(known.reindex(pd.MultiIndex.from_frame(frame[key])).to_numpy(), index=frame.index)
