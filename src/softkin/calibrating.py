"""Calibrate: stored outputs of the models, and the truth on `validation`, -> intervals on test and extrapolation."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pandas as pd

from softkin.bounds import bounds_frame
from softkin.evidence import Evidences, Run
from softkin.files import replacing
from softkin.interface import IntervalMethod, ShellEvidence
from softkin.intervals.inside_and_outside import is_informed

logger = logging.getLogger("softkin")

KEY = ["model", "preset", "subset", "confidence_level"]


def calibrate(
    evidences: Evidences,
    *,
    methods: Mapping[str, IntervalMethod],
    inside: Mapping[Run, IntervalMethod],
    intervals: Mapping[str, str | Path],
) -> None:
    """Write the `intervals` of each method (Parquet: model, preset, subset, confidence_level, lower_m1_x..,
    upper_m1_x.. in mm). `inside` says what a run is given inside the training region, where a method differs outside.
    """
    calibrated = {
        run: method.intervals(dict(evidences.of(method.on))[run], evidences.levels) for run, method in inside.items()
    }
    for place, (name, method) in enumerate(methods.items()):
        frames = []
        n_models = 0
        for run, evidence in evidences.of(method.on):
            model, preset = run
            n_models += 1
            if isinstance(evidence, ShellEvidence) and run in calibrated:
                informed = is_informed(inside[run])
                evidence = replace(evidence, inside=calibrated[run], inside_is_informed=informed)
            bounds = method.intervals(evidence, evidences.levels)
            for subset, mine in evidences.by_subset(bounds, axis=1).items():
                for level, of_level in zip(evidences.levels, mine, strict=True):
                    frame = bounds_frame(of_level, subset, level)
                    frame.insert(0, "model", model)
                    frame.insert(1, "preset", preset)
                    frames.append(frame)
        with replacing(intervals[name]) as temporary:
            (pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=KEY)).to_parquet(temporary)
        logger.info("%d of %d methods: %s around %d models", place + 1, len(methods), method.title, n_models)
