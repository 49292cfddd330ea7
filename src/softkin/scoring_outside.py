"""Score intervals for commands outside `train`, each beside the oracle: one dataset's extrapolation_intervals.csv."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.bounds import read_bounds
from softkin.datasets.table import read_subset
from softkin.evidence import INTERVAL_SUBSETS, Run, predicted_rows
from softkin.files import replacing
from softkin.interface import (
    NO_GUARANTEE,
    SUBSETS,
    TEST,
    TRAIN,
    VALIDATION,
    Array,
    IntervalMethod,
    informative_coordinates,
)
from softkin.metrics.interval import covered, widths, winkler_scores
from softkin.outside.method import NO_LABELS, Labelled, OutsideMethod
from softkin.shells import command_norm

COLUMNS = [
    *("dataset", "model", "preset", "interval_method", "confidence_level", "subset", "n_rows", "coverage"),
    *("joint_coverage", "mean_width_mm", "winkler_mm", "oracle_winkler_mm", "winkler_ratio_to_oracle"),
    *("infinite_share", "guarantee", "labels_used", "domain_auc", "effective_size", "refused"),
]


def score_outside(
    table: str | Path,
    *,
    dataset: str,
    standardised: bool,
    methods: Mapping[str, IntervalMethod],
    intervals: Mapping[str, str | Path],
    outside_methods: Mapping[str, OutsideMethod],
    predictions: Mapping[Run, str | Path],
    runs: Collection[Run],
    confidence_levels: list[float],
    seed: int,
    output: str | Path,
) -> None:
    """Write a row per run of `runs`, method, level and subset (test, extrapolation): means over the coordinates that
    move, of the `methods` with `intervals` (method -> file) around that run, and of `outside_methods`.

    `oracle_winkler_mm` is the score of the first of `outside_methods`. Where a method refuses, it has no scores.
    `standardised` says by which norm commands lie outside.
    """
    everything = {subset: read_subset(table, subset) for subset in SUBSETS}
    train = everything[TRAIN]
    moving = informative_coordinates(train.positions)
    norm = command_norm(train.commands, standardised=standardised).of
    stored = {name: pd.read_parquet(path) for name, path in intervals.items()}
    rows: list[dict[str, Any]] = []
    for run in runs:
        frame = pd.read_parquet(predictions[run])
        errors = {
            subset: (samples.positions - predicted_rows(frame, [subset]))[:, moving]
            for subset, samples in everything.items()
        }
        for subset in INTERVAL_SUBSETS:
            labelled = Labelled(
                train.commands,
                everything[VALIDATION].commands,
                errors[VALIDATION],
                everything[subset].commands,
                errors[subset],
                norm,
            )
            key = {"dataset": dataset, "model": run[0], "preset": run[1], "subset": subset}
            mine = [*_out_there(labelled, outside_methods, confidence_levels, seed)]
            true = everything[subset].positions
            mine += _ordinary(run, subset, methods, stored, true, moving, confidence_levels)
            rows += [key | row for row in mine]
    frame = pd.DataFrame(rows, columns=COLUMNS)
    frame["oracle_winkler_mm"] = _oracle(frame, next(iter(outside_methods)))
    frame["winkler_ratio_to_oracle"] = frame["winkler_mm"] / frame["oracle_winkler_mm"]
    with replacing(output) as temporary:
        frame.to_csv(temporary, index=False)


def _out_there(
    labelled: Labelled, methods: Mapping[str, OutsideMethod], levels: list[float], seed: int
) -> Iterator[dict[str, Any]]:
    for name, method in methods.items():
        answer = method.answer(labelled, levels, seed)
        errors = labelled.errors[answer.scored]
        for level, half, refused in zip(levels, answer.half_widths, answer.refused, strict=True):
            about: dict[str, Any] = {"interval_method": name, "confidence_level": level, **answer.details}
            about |= {"guarantee": method.guarantee, "labels_used": method.labels, "refused": refused}
            bounds = np.stack([-half, half], axis=-1)
            infinite = {"n_rows": len(errors), "infinite_share": np.isinf(half).mean() if half.size else np.nan}
            yield about | (infinite if refused else scores(errors, bounds, level))


def _ordinary(
    run: Run,
    subset: str,
    methods: Mapping[str, IntervalMethod],
    stored: Mapping[str, pd.DataFrame],
    true: Array,
    moving: NDArray[np.bool_],
    levels: list[float],
) -> Iterator[dict[str, Any]]:
    for name, method in methods.items():
        frame = stored[name]
        frame = frame[(frame["model"] == run[0]) & (frame["preset"] == run[1])]
        if frame.empty or method.on == "quantiles":  # whose learner is another
            continue
        guarantee = method.guarantee if subset == TEST else NO_GUARANTEE
        for level, bounds in zip(levels, read_bounds(frame, subset, levels), strict=True):
            about = {"interval_method": name, "guarantee": guarantee, "labels_used": NO_LABELS, "refused": ""}
            yield about | {"confidence_level": level, **scores(true[:, moving], bounds[:, moving], level)}


def scores(true: Array, bounds: Array, level: float) -> dict[str, float]:
    """Of intervals (n_rows, n_coordinates, 2), over all rows and coordinates; mm."""
    inside, width = covered(true, bounds), widths(bounds)
    return {
        "n_rows": len(true),
        "coverage": inside.mean(),
        "joint_coverage": inside.all(axis=1).mean(),
        "mean_width_mm": width.mean(),
        "winkler_mm": winkler_scores(true, bounds, level).mean(),
        "infinite_share": np.isinf(width).mean(),
    }


def _oracle(frame: pd.DataFrame, name: str) -> pd.Series:
    """The oracle's Winkler score of the same run, level and subset."""
    key = ["model", "preset", "confidence_level", "subset"]
    known = frame[frame["interval_method"] == name].set_index(key)["winkler_mm"]
    return pd.Series(known.reindex(pd.MultiIndex.from_frame(frame[key])).to_numpy(), index=frame.index)
