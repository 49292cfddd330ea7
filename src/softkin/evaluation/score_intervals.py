"""Score intervals: intervals and true positions of one dataset -> its interval_metrics.csv."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.bounds import bounds_levels, read_bounds
from softkin.core.csv_tables import write_csv
from softkin.core.errors import DataError
from softkin.core.failed_parts import INTERVAL_METHODS, of_part
from softkin.core.metrics.interval import (
    clopper_pearson,
    coverage_band,
    coverage_p_value,
    covered,
    geometric_size,
    holm,
    widths,
    winkler_scores,
)
from softkin.core.rows import row_groups
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, TEST, Array, coordinate_columns, informative_coordinates, measured_coordinates
from softkin.data.audit.gross_rows import gross_rows
from softkin.data.table import read_subset
from softkin.evaluation.score_regions import covered_share, region_rows
from softkin.uncertainty.calibration_data import CalibrationData, QuantileCalibration
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE, IntervalMethod
from softkin.uncertainty.regions.spec import RegionMethod
from softkin.uncertainty.stored_outputs import INTERVAL_SUBSETS, StoredOutputs


@dataclass(frozen=True, slots=True)
class _Setting:
    """What the rows of one method around one run have in common at one level; the guarantee is that on this subset,
    `gross` the mask (n_rows,) of its gross errors, `block` (n_rows,) the held-out block of each row, if there are any.
    """

    file: str | Path
    true: Array
    informative: NDArray[np.bool_]
    n_calibration: int
    level: float
    method: IntervalMethod[Any]
    guarantee: str
    gross: NDArray[np.bool_]
    n_commands: int
    block: NDArray[np.int64] | None


def score_intervals(
    table: str | Path,
    *,
    dataset: str,
    methods: Mapping[str, IntervalMethod[Any]],
    intervals: Mapping[str, str | Path],
    regions: Mapping[str, RegionMethod],
    outputs: StoredOutputs,
    output: str | Path,
    joint: Iterable[Mapping[str, Any]] = (),
) -> None:
    """Write a row per subset, model, preset, method, coordinate and level.

    Winkler scores are given of all rows and without gross errors, those that the audit names.

    Parameters:
        table: the tidy table.
        dataset: its name.
        methods: interval methods by name.
        intervals: method -> file of its intervals.
        regions: joint regions by name, calibrated here; each has one row, `joint`.
        outputs: the stored outputs that the intervals were calibrated on.
        output: the metrics (CSV).
        joint: the rows of the calibrated model's joint intervals, from `joint_rows`.

    Raises:
        DataError: a symmetric interval of constant width has a mean Winkler score below twice its mean absolute error,
            which cannot be: files of different runs were mixed.
    """
    samples = {subset: read_subset(table, subset) for subset in SUBSETS}
    gross = gross_rows(samples)
    n_commands = {subset: int(row_groups(rows.commands).max()) + 1 for subset, rows in samples.items()}
    truth = {subset: samples[subset].positions for subset in INTERVAL_SUBSETS}
    informative = informative_coordinates(outputs.train.positions)
    rows: list[dict[str, Any]] = []
    for name, method in methods.items():
        n_calibration = _n_calibration(method, outputs)
        stored = dict(list(pd.read_parquet(intervals[name]).groupby(["model", "preset"], sort=False)))
        for run, data in outputs.of(method.calibrated_on):
            with of_part(INTERVAL_METHODS, name):
                scores, levels = _crps(method, outputs, data, truth), bounds_levels(stored[run])
            for subset, true in truth.items():
                bounds = read_bounds(stored[run], subset, levels)
                crossings = _crossings(method, outputs, run, subset, bounds)
                for place, level in enumerate(levels):
                    guarantee = _guarantee(outputs, method, level) if subset == TEST else NO_GUARANTEE
                    setting = _Setting(
                        intervals[name], true, informative, n_calibration, level, method, guarantee,
                        gross[subset], n_commands[subset], samples[subset].block,
                    )  # fmt: skip
                    key = {"dataset": dataset, "subset": subset, "model": run.model, "preset": run.preset}
                    key |= {"interval_method": name}
                    rows += [key | row for row in _rows(setting, bounds[place], crossings[place], scores[subset])]
    rows += [{"dataset": dataset, **row} for row in region_rows(outputs, samples, regions)]
    rows += [{"dataset": dataset, **row} for row in joint]
    write_csv(output, pd.DataFrame(rows))


def _guarantee(outputs: StoredOutputs, method: IntervalMethod[Any], level: float) -> str:
    """What the method promises of rows of `test`."""
    return method.guarantee if outputs.promise is None else outputs.promise.guarantee(method, level)


def _n_calibration(method: IntervalMethod[Any], outputs: StoredOutputs) -> int:
    """Number of rows that the method is calibrated on; 0 if nothing is guaranteed."""
    if method.guarantee == NO_GUARANTEE:
        return 0
    return len(outputs.train if method.calibrated_on.needs_refits else outputs.validation)


def _crps(
    method: IntervalMethod[Any],
    outputs: StoredOutputs,
    data: CalibrationData,
    truth: Mapping[str, Array],
) -> Mapping[str, Array]:
    """CRPS (n_rows, n_coordinates) in mm per subset; NaN for a method without a distribution."""
    if method.crps is None:
        return {subset: np.full(true.shape, np.nan) for subset, true in truth.items()}
    return outputs.by_subset(method.crps(data, np.concatenate(list(truth.values()))))


def _crossings(
    method: IntervalMethod[Any], outputs: StoredOutputs, run: Run, subset: str, bounds: Array
) -> NDArray[np.bool_]:
    """Whether predicted quantiles crossed before they were put in order, (n_levels, n_rows, n_coordinates)."""
    if method.calibrated_on is not QuantileCalibration:
        return np.zeros(bounds.shape[:-1], dtype=bool)
    # Where quantiles were fitted for one level, all levels are made from its pair.
    fitted = bounds_levels(outputs.quantiles[run])
    raw = read_bounds(outputs.quantiles[run], subset, fitted if len(fitted) == len(bounds) else fitted[:1])
    return np.broadcast_to(raw[..., 0] > raw[..., 1], bounds.shape[:-1])


def _rows(setting: _Setting, bounds: Array, crossings: NDArray[np.bool_], scores: Array) -> Iterator[dict[str, Any]]:
    """A row per coordinate, two means over coordinates, and one of all moving coordinates together."""
    is_covered = covered(setting.true, bounds)
    width = widths(bounds)
    winkler = winkler_scores(setting.true, bounds, setting.level)
    infinite = np.isinf(width)
    if setting.method.has_constant_width and not infinite.any():
        _check_winkler(setting, bounds, winkler)
    n_rows, n_coordinates = setting.true.shape
    bands = [_band(setting, int(count)) for count in is_covered.sum(axis=0)]
    # Holm over moving coordinates only: constant ones carry no information and would inflate the adjusted p-values.
    adjusted = np.full(n_coordinates, np.nan)
    if setting.guarantee == MARGINAL:
        p_values = np.array([band["coverage_p_value"] for band in bands])
        adjusted[setting.informative] = holm(p_values[setting.informative])
    common = {"confidence_level": setting.level, "n_calibration": setting.n_calibration, "n_rows": n_rows}
    common |= {"n_commands": setting.n_commands, "n_gross_rows": int(setting.gross.sum())}
    regular = winkler[~setting.gross] if not setting.gross.all() else np.full_like(winkler, np.nan)

    def averages(mask: Any) -> dict[str, Any]:
        return {
            "coverage": covered_share(is_covered[:, mask], setting.block),
            "mean_width_mm": width[:, mask].mean(),
            "winkler_mm": winkler[:, mask].mean(),
            "winkler_without_gross_mm": regular[:, mask].mean(),
            "crps_mm": scores[:, mask].mean(),
            "infinite_share": infinite[:, mask].mean(),
            "crossing_share": crossings[:, mask].mean(),
            "guarantee": setting.guarantee,
        }

    for i, name in enumerate(coordinate_columns(n_coordinates // 3)):
        yield {**common, "coordinate": name, **averages(i), **bands[i], "coverage_p_value_holm": adjusted[i]}
    for name, mask in (("mean", measured_coordinates(setting.true)), ("mean_informative", setting.informative)):
        yield {**common, "coordinate": name, **averages(mask)}
    together = np.asarray(is_covered[:, setting.informative].all(axis=1))
    low, high = clopper_pearson(int(together.sum()), n_rows)
    yield {
        **common,
        "coordinate": "joint",
        "coverage": covered_share(together, setting.block),
        "coverage_low": low,
        "coverage_high": high,
        "size_mm": geometric_size(width[:, setting.informative]).mean(),
        "infinite_share": infinite[:, setting.informative].any(axis=1).mean(),
        "crossing_share": crossings[:, setting.informative].any(axis=1).mean(),
        "guarantee": NO_GUARANTEE,
    }


def _check_winkler(setting: _Setting, bounds: Array, winkler: Array) -> None:
    least = 2 * np.abs(setting.true - bounds.mean(axis=-1)).mean(axis=0)
    if (winkler.mean(axis=0) < least * (1 - 1e-6)).any():
        raise DataError(
            "a mean Winkler score lies below twice the mean absolute error, which no symmetric interval of constant "
            "width can have: files of different runs were mixed",
            where=setting.file,
            fix="delete the folder of this file and run again",
        )


def _band(setting: _Setting, n_covered: int) -> dict[str, float]:
    """The band in which the coverage must lie and its p-value; without a guarantee its Clopper-Pearson interval."""
    n_rows = len(setting.true)
    if setting.guarantee != MARGINAL or setting.method.rank is None:
        low, high = clopper_pearson(n_covered, n_rows)
        return {"coverage_low": low, "coverage_high": high, "coverage_p_value": np.nan}
    rank = setting.method.rank(setting.n_calibration, setting.level)
    if rank is None:  # infinite intervals cover everything
        return {"coverage_low": 1.0, "coverage_high": 1.0, "coverage_p_value": 1.0}
    low, high = coverage_band(n_rows, setting.n_calibration, rank)
    p_value = coverage_p_value(n_covered, n_rows, setting.n_calibration, rank)
    return {"coverage_low": low, "coverage_high": high, "coverage_p_value": p_value}
