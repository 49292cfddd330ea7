"""Calibrate: stored predictions or quantiles, and the truth on `validation`, -> intervals on the other subsets."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from softkin.datasets.table import read_subset
from softkin.files import replacing
from softkin.interface import EXTRAPOLATION, TEST, VALIDATION, Array, Evidence, IntervalMethod, coordinate_columns
from softkin.quantiles import bounds_frame, read_bounds

logger = logging.getLogger("softkin")

INTERVAL_SUBSETS = (TEST, EXTRAPOLATION)


def calibrate(
    table: str | Path,
    *,
    method: IntervalMethod,
    sources: Mapping[tuple[str, str], str],
    confidence_levels: Sequence[float],
    intervals: str | Path,
) -> None:
    """Write the `intervals` (Parquet: model, preset, subset, confidence_level, lower_m1_x.., upper_m1_x.. in mm).

    `sources` is (model, preset) -> file of predictions or of quantiles, whichever the method starts from. Of `table`
    only the rows of `validation` are read.
    """
    truth = read_subset(table, VALIDATION).positions
    read = STORED[method.on]
    frames = []
    for (model, preset), source in sources.items():
        stored = pd.read_parquet(source)
        calibration = read(stored, VALIDATION, confidence_levels)
        for subset in INTERVAL_SUBSETS:
            evidence = Evidence(calibration, truth, read(stored, subset, confidence_levels))
            bounds = method.intervals(evidence, confidence_levels)
            for place, level in enumerate(confidence_levels):
                frame = bounds_frame(bounds[place], subset, level)
                frame.insert(0, "model", model)
                frame.insert(1, "preset", preset)
                frames.append(frame)
    with replacing(intervals) as temporary:
        pd.concat(frames, ignore_index=True).to_parquet(temporary, index=False)
    logger.info("%s: intervals of %d models from %d calibration rows", method.title, len(sources), len(truth))


def read_predictions(stored: pd.DataFrame, subset: str, confidence_levels: Sequence[float]) -> Array:  # noqa: ARG001
    """Predicted positions (n_rows, n_coordinates) of one subset; they know no level."""
    rows: Array = stored[stored["subset"] == subset].filter(regex=r"^m\d+_[xyz]$").to_numpy()
    assert list(stored.columns[1:]) == coordinate_columns(rows.shape[1] // 3)
    return rows


#: What a method is `on` -> reader of it.
STORED = {"predictions": read_predictions, "quantiles": read_bounds}
