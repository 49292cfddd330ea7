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
from softkin.core.csv_tables import write_csv
from softkin.core.metrics.interval import covered, fewest_commands, widths, winkler_scores
from softkin.core.rows import row_groups
from softkin.core.runs import Run
from softkin.core.samples import (
    SUBSETS,
    TEST,
    TRAIN,
    VALIDATION,
    Array,
    Samples,
    coordinate_columns,
    informative_coordinates,
)
from softkin.core.shells import command_norm
from softkin.data.audit.gross_rows import gross_rows
from softkin.data.table import read_subset
from softkin.evaluation.beside_oracle import ratios
from softkin.training.predict import predicted_rows
from softkin.uncertainty.intervals.spec import NO_GUARANTEE, IntervalMethod
from softkin.uncertainty.labelled.spec import NO_LABELS, Labelled, LabelledMethod
from softkin.uncertainty.stored_outputs import INTERVAL_SUBSETS

COLUMNS = [
    *("dataset", "model", "preset", "interval_method", "confidence_level", "subset", "n_rows", "coverage"),
    *("joint_coverage", "worst_coordinate", "worst_coverage", "mean_width_mm", "winkler_mm", "oracle_winkler_mm"),
    *("winkler_ratio_to_oracle", "ratio_low", "ratio_high", "n_commands", "assessable", "n_gross_rows"),
    *("winkler_without_gross_mm", "ratio_without_gross"),
    *("infinite_share", "guarantee", "labels_used", "domain_auc", "effective_size", "refused"),
]


@dataclass(frozen=True)
class ScoredRun:
    """One run on one subset: the input of labelled methods, the true positions (n_rows, n_coordinates) in mm, and the
    mask (n_rows,) of its gross errors.
    """

    run: Run
    subset: str
    labelled: Labelled
    true: Array
    moving: NDArray[np.bool_]
    gross: NDArray[np.bool_]


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
    Beside each ratio to the oracle stand its band over draws of the commands, the number of distinct commands and
    whether these can tell a coverage (`assessable`), the coordinate covered least, and the scores without gross errors.

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
    gross = gross_rows(samples)
    of_runs = [[("model", "==", run.model), ("preset", "==", run.preset)] for run in runs] or None
    stored = {name: pd.read_parquet(path, filters=of_runs) for name, path in methods.intervals.items()}
    rows: list[dict[str, Any]] = []
    for run in runs:
        for scored in _scored_runs(run, pd.read_parquet(predictions[run]), samples, gross, norm):
            rows += _rows(dataset, scored, [*_labelled_rows(scored, methods), *_interval_rows(scored, methods, stored)])
    frame = pd.DataFrame(rows, columns=COLUMNS)
    write_csv(output, frame)


#: A row of the table, and the Winkler scores (n_rows,) of the subset's rows; NaN where one got no interval.
Scored = tuple[dict[str, Any], Array]


def _rows(dataset: str, scored: ScoredRun, answers: Sequence[Scored]) -> Iterator[dict[str, Any]]:
    """The rows of one run and subset, each beside the oracle at its level, which is the first labelled method."""
    key: dict[str, Any] = {"dataset": dataset, "model": scored.run.model, "preset": scored.run.preset}
    key["subset"] = scored.subset
    first = answers[0][0]["interval_method"]
    oracles = {row["confidence_level"]: i for i, (row, _) in enumerate(answers) if row["interval_method"] == first}
    commands = row_groups(scored.labelled.commands)
    n_commands = int(commands.max()) + 1
    key |= {"n_commands": n_commands, "n_gross_rows": int(scored.gross.sum())}
    row_scores = np.array([winkler for _, winkler in answers])
    of_oracle = [oracles[row["confidence_level"]] for row, _ in answers]
    beside = ratios(row_scores, of_oracle, commands, scored.gross)
    for place, (row, winkler) in enumerate(answers):
        given = ~np.isnan(winkler) & ~scored.gross
        yield (
            key
            | row
            | {name: values[place] for name, values in beside.items()}
            | {
                "assessable": n_commands >= fewest_commands(row["confidence_level"]),
                "oracle_winkler_mm": answers[of_oracle[place]][0].get("winkler_mm", np.nan),
                "winkler_without_gross_mm": winkler[given].mean() if given.any() else np.nan,
            }
        )


def _scored_runs(
    run: Run,
    predictions: pd.DataFrame,
    samples: Mapping[str, Samples],
    gross: Mapping[str, NDArray[np.bool_]],
    norm: Callable[[Array], Array],
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
        yield ScoredRun(run, subset, labelled, samples[subset].positions, moving, gross[subset])


def _labelled_rows(scored: ScoredRun, methods: ExtrapolationMethods) -> Iterator[Scored]:
    """Rows of the labelled methods."""
    levels = methods.confidence_levels
    for name, method in methods.labelled.items():
        answer = method.answer(scored.labelled, levels, methods.seed)
        errors = scored.labelled.errors[answer.scored]
        for level, half, refused in zip(levels, answer.half_widths, answer.refused, strict=True):
            row: dict[str, Any] = {"interval_method": name, "confidence_level": level, **answer.details}
            row |= {"guarantee": method.guarantee, "labels_used": method.labels, "refused": refused}
            infinite = {"n_rows": len(errors), "infinite_share": np.isinf(half).mean() if half.size else np.nan}
            winkler = np.full(len(scored.true), np.nan)
            if not refused:
                bounds = np.stack([-half, half], axis=-1)
                winkler[answer.scored] = winkler_scores(errors, bounds, level).mean(axis=1)
            yield row | (infinite if refused else scores(errors, bounds, level, scored.moving)), winkler


def _interval_rows(
    scored: ScoredRun, methods: ExtrapolationMethods, stored: Mapping[str, pd.DataFrame]
) -> Iterator[Scored]:
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
            true, of_moving = scored.true[:, moving], bounds[:, moving]
            winkler = winkler_scores(true, of_moving, level).mean(axis=1)
            yield row | {"confidence_level": level, **scores(true, of_moving, level, moving)}, winkler


def scores(true: Array, bounds: Array, level: float, moving: NDArray[np.bool_]) -> dict[str, Any]:
    """Scores of intervals (n_rows, n_coordinates, 2) in mm, over all rows and coordinates: the `moving` ones."""
    is_covered, width = covered(true, bounds), widths(bounds)
    of_coordinates = is_covered.mean(axis=0)
    names = np.array(coordinate_columns(len(moving) // 3))[moving]
    return {
        "n_rows": len(true),
        "coverage": is_covered.mean(),
        "joint_coverage": is_covered.all(axis=1).mean(),
        "worst_coordinate": names[of_coordinates.argmin()],
        "worst_coverage": of_coordinates.min(),
        "mean_width_mm": width.mean(),
        "winkler_mm": winkler_scores(true, bounds, level).mean(),
        "infinite_share": np.isinf(width).mean(),
    }
