"""Score intervals: intervals and truth of one dataset -> its rows of interval_metrics.csv."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.calibrating import INTERVAL_SUBSETS
from softkin.conformal import conformal_rank
from softkin.datasets.table import read_subset
from softkin.files import replacing
from softkin.interface import (
    TEST,
    TRAIN,
    VALIDATION,
    Array,
    IntervalMethod,
    coordinate_columns,
    informative_coordinates,
)
from softkin.metrics.interval import (
    clopper_pearson,
    coverage_band,
    coverage_p_value,
    covered,
    holm,
    widths,
    winkler_scores,
)
from softkin.quantiles import read_bounds

NO_GUARANTEE = "no guarantee"
MARGINAL = "marginal"


@dataclass(frozen=True, slots=True)
class _Setting:
    """What all rows of one interval have in common."""

    true: Array
    informative: NDArray[np.bool_]
    n_calibration: int
    level: float
    guaranteed: bool


def score_intervals(
    table: str | Path,
    *,
    dataset: str,
    methods: Mapping[str, IntervalMethod],
    intervals: Mapping[str, str],
    quantiles: Mapping[tuple[str, str], str],
    confidence_levels: Sequence[float],
    output: str | Path,
) -> None:
    """Write a row per subset, model, preset, method, coordinate and level.

    `intervals` is method -> its intervals; `quantiles` is (learner, preset) -> predicted quantiles, to count where
    they crossed.
    """
    truth = {subset: read_subset(table, subset).positions for subset in INTERVAL_SUBSETS}
    n_calibration = len(read_subset(table, VALIDATION))
    informative = informative_coordinates(read_subset(table, TRAIN).positions)
    crossed = {key: pd.read_parquet(path) for key, path in quantiles.items()}
    rows: list[dict[str, Any]] = []
    for name, path in intervals.items():
        stored = pd.read_parquet(path)
        for (model, preset), mine in stored.groupby(["model", "preset"], sort=False):
            for subset, true in truth.items():
                bounds = read_bounds(mine, subset, confidence_levels)
                raw = None
                if methods[name].on == "quantiles":
                    raw = read_bounds(crossed[str(model), str(preset)], subset, confidence_levels)
                for place, level in enumerate(confidence_levels):
                    guaranteed = methods[name].guaranteed and subset == TEST
                    setting = _Setting(true, informative, n_calibration, level, guaranteed)
                    crossings = np.zeros(true.shape, bool) if raw is None else raw[place, ..., 0] > raw[place, ..., 1]
                    key = {"dataset": dataset, "subset": subset, "model": model, "preset": preset}
                    key |= {"interval_method": name}
                    rows += [key | row for row in _rows(setting, bounds[place], crossings)]
    with replacing(output) as temporary:
        pd.DataFrame(rows).to_csv(temporary, index=False)


def _rows(setting: _Setting, bounds: Array, crossings: NDArray[np.bool_]) -> Iterator[dict[str, Any]]:
    inside = covered(setting.true, bounds)
    width = widths(bounds)
    winkler = winkler_scores(setting.true, bounds, setting.level)
    infinite = np.isinf(width)
    n_rows, n_coordinates = setting.true.shape
    bands = [_band(setting, int(count)) for count in inside.sum(axis=0)]
    adjusted = holm(np.array([band["coverage_p_value"] for band in bands])) if setting.guaranteed else None
    common = {"confidence_level": setting.level, "n_calibration": setting.n_calibration, "n_rows": n_rows}
    for i, name in enumerate(coordinate_columns(n_coordinates // 3)):
        yield {
            **common,
            "coordinate": name,
            "coverage": inside[:, i].mean(),
            **bands[i],
            "coverage_p_value_holm": np.nan if adjusted is None else adjusted[i],
            "mean_width_mm": width[:, i].mean(),
            "winkler_mm": winkler[:, i].mean(),
            "infinite_share": infinite[:, i].mean(),
            "crossing_share": crossings[:, i].mean(),
            "guarantee": MARGINAL if setting.guaranteed else NO_GUARANTEE,
        }
    for name, mask in (("mean", np.ones(n_coordinates, bool)), ("mean_informative", setting.informative)):
        yield {
            **common,
            "coordinate": name,
            "coverage": inside[:, mask].mean(),
            "mean_width_mm": width[:, mask].mean(),
            "winkler_mm": winkler[:, mask].mean(),
            "infinite_share": infinite[:, mask].mean(),
            "crossing_share": crossings[:, mask].mean(),
            "guarantee": MARGINAL if setting.guaranteed else NO_GUARANTEE,
        }
    together = inside[:, setting.informative].all(axis=1)
    low, high = clopper_pearson(int(together.sum()), n_rows)
    yield {
        **common,
        "coordinate": "joint",
        "coverage": together.mean(),
        "coverage_low": low,
        "coverage_high": high,
        "infinite_share": infinite[:, setting.informative].any(axis=1).mean(),
        "crossing_share": crossings[:, setting.informative].any(axis=1).mean(),
        "guarantee": NO_GUARANTEE,
    }


def _band(setting: _Setting, n_covered: int) -> dict[str, float]:
    """With a guarantee, the band in which its coverage must lie and the p-value; else the coverage's own interval."""
    n_rows = len(setting.true)
    rank = conformal_rank(setting.n_calibration, setting.level)
    if not setting.guaranteed:
        low, high = clopper_pearson(n_covered, n_rows)
        return {"coverage_low": low, "coverage_high": high, "coverage_p_value": np.nan}
    if rank is None:  # infinite intervals cover everything
        return {"coverage_low": 1.0, "coverage_high": 1.0, "coverage_p_value": 1.0}
    low, high = coverage_band(n_rows, setting.n_calibration, rank)
    p_value = coverage_p_value(n_covered, n_rows, setting.n_calibration, rank)
    return {"coverage_low": low, "coverage_high": high, "coverage_p_value": p_value}
