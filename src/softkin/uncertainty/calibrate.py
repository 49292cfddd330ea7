"""Calibrate intervals: stored outputs of models and true positions of `validation` -> intervals on the new rows."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd

from softkin.core.bounds import ROW_GROUP, bounds_frame
from softkin.core.failed_parts import INTERVAL_METHODS, of_part
from softkin.core.files import replacing
from softkin.core.runs import Run
from softkin.uncertainty.calibration_data import ShellCalibration
from softkin.uncertainty.intervals.spec import IntervalMethod
from softkin.uncertainty.stored_outputs import StoredOutputs

logger = logging.getLogger("softkin")

KEY = ["model", "preset", "subset", "confidence_level"]


def calibrate(
    outputs: StoredOutputs,
    *,
    methods: Mapping[str, IntervalMethod[Any]],
    in_domain: Mapping[Run, IntervalMethod[Any]],
    intervals: Mapping[str, str | Path],
) -> None:
    """Write the intervals of each method around each run on test and extrapolation.

    `intervals` is method -> output (Parquet: model, preset, subset, confidence_level, lower_m1_x.., upper_m1_x.. in
    mm). `in_domain` is run -> the method whose intervals a method for extrapolation keeps in-domain.
    """
    calibrated = {}
    for run, method in in_domain.items():
        with of_part(INTERVAL_METHODS, method.name):
            calibrated[run] = method.intervals(dict(outputs.of(method.calibrated_on))[run], outputs.levels)
    for place, (name, method) in enumerate(methods.items()):
        frames = []
        n_models = 0
        with of_part(INTERVAL_METHODS, name):
            for run, data in outputs.of(method.calibrated_on):
                n_models += 1
                if isinstance(data, ShellCalibration) and run in calibrated:
                    has_spread = in_domain[run].calibrated_on.has_spread
                    data = replace(data, in_domain=calibrated[run], in_domain_has_spread=has_spread)
                levels = method.levels(data, outputs.levels)
                bounds = method.intervals(data, levels)
                for subset, of_subset in outputs.by_subset(bounds, axis=1).items():
                    for level, of_level in zip(levels, of_subset, strict=True):
                        frame = bounds_frame(of_level, subset, level)
                        frame.insert(0, "model", run.model)
                        frame.insert(1, "preset", run.preset)
                        frames.append(frame)
        with replacing(intervals[name]) as temporary:
            table = pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=KEY)
            # Bounds hardly repeat: a dictionary of them takes most of the time of writing, and a sixth of the file.
            table.to_parquet(temporary, row_group_size=ROW_GROUP, use_dictionary=KEY)
        logger.info("%d of %d methods: %s around %d models", place + 1, len(methods), method.title, n_models)
