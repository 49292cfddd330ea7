"""Score joint regions and alarms: residuals of every run -> coverage and size, and rates of alarms."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.csv_tables import write_csv
from softkin.core.failed_parts import REGIONS, of_part
from softkin.core.metrics.interval import clopper_pearson, coverage_band, coverage_p_value
from softkin.core.runs import Run
from softkin.core.samples import TEST, TRAIN, VALIDATION, Array, Samples, informative_coordinates
from softkin.training.predict import predicted_rows
from softkin.uncertainty.conformal import conformal_rank, error_scale, joint_scores, p_values
from softkin.uncertainty.intervals.spec import NO_GUARANTEE
from softkin.uncertainty.promise import Promise, own_rows
from softkin.uncertainty.regions.spec import RegionMethod, divided
from softkin.uncertainty.stored_outputs import INTERVAL_SUBSETS, StoredOutputs

#: Displacements (mm) of the whole robot at which the rate of alarms is measured; 0 gives the false alarms.
DISPLACEMENTS_MM = (0.0, 1.0, 2.0, 5.0, 10.0)
#: Guarantees of the joint coverage of a region.
JOINT, AT_LEAST = "joint", "joint, at least"


def moving_residuals(outputs: StoredOutputs, truth: Mapping[str, Array]) -> Iterator[tuple[Run, dict[str, Array]]]:
    """Each run with its residuals by subset: true minus predicted moving coordinates (n_rows, n_moving) in mm."""
    moving = informative_coordinates(truth[TRAIN])
    for run, stored in outputs.predictions.items():
        residuals = {subset: (true - predicted_rows(stored, [subset]))[:, moving] for subset, true in truth.items()}
        yield run, residuals | {VALIDATION: residuals[VALIDATION][outputs.calibrated]}


def region_rows(
    outputs: StoredOutputs, samples: Mapping[str, Samples], methods: Mapping[str, RegionMethod]
) -> Iterator[dict[str, Any]]:
    """A row of interval_metrics.csv per run, region, level and subset; `samples` is subset -> rows, of all."""
    truth = {subset: rows.positions for subset, rows in samples.items()}
    markers = _markers(truth)
    blocks = {subset: rows.block for subset, rows in samples.items()}
    for (model, preset), residuals in moving_residuals(outputs, truth):
        for name, method in methods.items():
            for level in outputs.levels:
                with of_part(REGIONS, name):
                    rows = list(_coverages(method, residuals, markers, level, blocks, outputs.promise))
                yield from ({"model": model, "preset": preset, "interval_method": name, **row} for row in rows)


def score_alarms(
    outputs: StoredOutputs, samples: Mapping[str, Samples], *, dataset: str, seed: int, output: str | Path
) -> None:
    """Write the share of rows that their p-value calls anomalous, by run, level, subset and displacement.

    Parameters:
        outputs: stored outputs of the dataset.
        samples: subset -> rows, of all subsets.
        dataset: its name.
        seed: of the directions of displacements.
        output: the rates (CSV).
    """
    truth = {subset: of_subset.positions for subset, of_subset in samples.items()}
    blocks = {subset: of_subset.block for subset, of_subset in samples.items()}
    rows = []
    for (model, preset), residuals in moving_residuals(outputs, truth):
        for level in outputs.levels:
            rates = alarm_rates(residuals, _markers(truth), level, seed, blocks, outputs.promise)
            rows += [{"dataset": dataset, "model": model, "preset": preset, **row} for row in rates]
    write_csv(output, pd.DataFrame(rows))


def _markers(truth: Mapping[str, Array]) -> NDArray[np.intp]:
    """Marker (n_moving,) of each moving coordinate."""
    return np.flatnonzero(informative_coordinates(truth[TRAIN])) // 3


def _coverages(
    method: RegionMethod,
    residuals: Mapping[str, Array],
    markers: NDArray[np.intp],
    level: float,
    blocks: Mapping[str, NDArray[np.int64] | None],
    promise: Promise | None,
) -> Iterator[dict[str, Any]]:
    """A row per subset of one region at one level; with a `promise` it is calibrated on blocks."""
    asked, guarantee = level, JOINT if method.is_exact else AT_LEAST
    if promise is not None:
        n_parts = len(markers) if method.is_divided else 1
        single = divided(level, n_parts)
        asked, guarantee = 1 - n_parts * (1 - promise.asked(single)), promise.of_region(guarantee, single)
    region = method.region(residuals[TRAIN], residuals[VALIDATION], markers, asked)
    for subset in INTERVAL_SUBSETS:
        is_covered, n_calibration = region.covers(residuals[subset]), len(residuals[VALIDATION])
        row = coverage_row(subset, level, is_covered, n_calibration, blocks[subset], guarantee)
        yield row | {"infinite_share": float(np.isinf(region.size_mm)), "size_mm": region.size_mm}


def coverage_row(
    subset: str,
    level: float,
    is_covered: NDArray[np.bool_],
    n_calibration: int,
    block: NDArray[np.int64] | None,
    guarantee: str,
) -> dict[str, Any]:
    """The coverage of a joint region on the rows of a subset, beside its exact band where it has one there.

    Parameters:
        subset: test or extrapolation.
        level: of the region.
        is_covered: whether it holds each row (n_rows,).
        n_calibration: rows that it is calibrated on.
        block: the held-out block of each row (n_rows,); None where there are none.
        guarantee: on rows of `test`; the band is that of `JOINT`.
    """
    n_rows, n_covered = len(is_covered), int(is_covered.sum())
    rank = conformal_rank(n_calibration, level)
    low, high = clopper_pearson(n_covered, n_rows)
    p_value = float("nan")
    if subset == TEST and guarantee == JOINT and rank is not None:
        low, high = coverage_band(n_rows, n_calibration, rank)
        p_value = coverage_p_value(n_covered, n_rows, n_calibration, rank)
    return {
        "subset": subset,
        "confidence_level": level,
        "n_calibration": n_calibration,
        "n_rows": n_rows,
        "coordinate": "joint",
        "coverage": covered_share(is_covered, block),
        "crossing_share": 0.0,
        "guarantee": guarantee if subset == TEST else NO_GUARANTEE,
        "coverage_low": low,
        "coverage_high": high,
        "coverage_p_value": p_value,
    }


def covered_share(is_covered: NDArray[np.bool_], block: NDArray[np.int64] | None) -> float:
    """Share of what is covered (n_rows, ...); of held-out blocks their mean, whatever rows each has."""
    if block is None:
        return float(is_covered.mean())
    return float(np.mean([is_covered[block == number].mean() for number in np.unique(block)]))


def alarm_rates(
    residuals: Mapping[str, Array],
    markers: NDArray[np.intp],
    level: float,
    seed: int,
    blocks: Mapping[str, NDArray[np.int64] | None],
    promise: Promise | None,
) -> Iterator[dict[str, Any]]:
    """Share of rows whose p-value is at most alpha = 1 - level: mean over single coordinates, and of whole poses.

    All markers of a row are displaced in one random direction. Alarms on `test` without displacement are false ones;
    their expected share is at most alpha. With a `promise` p-values count blocks, as those of the calibrated model do,
    shares are means over held-out blocks, and have no bounds: rows of a block are alike.
    """
    alpha = round(1 - level, 12)
    calibration = residuals[VALIDATION]
    scale, own, nan = error_scale(np.abs(residuals[TRAIN])), own_rows(promise, level), float("nan")
    for subset in INTERVAL_SUBSETS:
        block = blocks[subset]
        direction = np.random.default_rng(seed).standard_normal((len(residuals[subset]), 3))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        for displacement in DISPLACEMENTS_MM:
            axes = _axes(markers)
            moved = residuals[subset] + displacement * direction[:, axes]
            single = p_values(np.abs(calibration), np.abs(moved), own=own) <= alpha
            scores = (joint_scores(rows, scale) for rows in (calibration, moved))
            joint = p_values(*scores, own=own) <= alpha
            low, high = clopper_pearson(int(joint.sum()), len(joint)) if block is None else (nan, nan)
            yield {
                "subset": subset,
                "alpha": alpha,
                "displacement_mm": displacement,
                "n_rows": len(joint),
                "coordinate_alarm_rate": covered_share(single, block),
                "joint_alarm_rate": covered_share(joint, block),
                "joint_low": low,
                "joint_high": high,
            }


def _axes(markers: NDArray[np.intp]) -> NDArray[np.intp]:
    """Place (0, 1, 2) of each coordinate (n_moving,) among the moving coordinates of its marker."""
    starts = np.r_[True, markers[1:] != markers[:-1]]
    place = np.arange(len(markers))
    return place - np.maximum.accumulate(np.where(starts, place, 0))
