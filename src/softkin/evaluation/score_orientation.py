"""Score the model of the tip's orientation: angles in degrees, and how often a bound on the angle holds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.core.csv_tables import write_csv
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN
from softkin.data.table import read_subset
from softkin.uncertainty.intervals.spec import NO_GUARANTEE
from softkin.uncertainty.orientation_model import OrientationModel


def score_orientation(
    model: OrientationModel, table: str | Path, *, dataset: str, confidence_levels: Sequence[float], output: str | Path
) -> None:
    """Write a row for each of `train`, `test` and `extrapolation` and each level: mean_deg and rms_deg of the angle
    between predicted and measured rotation, and the bound at the level with its coverage. Those of `train` are of
    held-out folds; only those of `test` are promised anything.

    Parameters:
        model: fitted and calibrated.
        table: the tidy table (Parquet).
        dataset: its name.
        confidence_levels: nominal levels.
        output: the scores (CSV).
    """
    missed = {TRAIN: model.missed}
    missed |= {subset: model.angles(read_subset(table, subset)) for subset in (TEST, EXTRAPOLATION)}
    rows = [
        {
            "dataset": dataset,
            "model": model.model,
            "subset": subset,
            "n_rows": len(angles),
            "mean_deg": angles.mean(),
            "rms_deg": np.sqrt((angles**2).mean()),
            "confidence_level": level,
            "bound_deg": (bound := model.bound(level)),
            "coverage": (angles <= bound).mean(),
            "guarantee": model.guarantee(level) if subset == TEST else NO_GUARANTEE,
        }
        for subset, angles in missed.items()
        for level in confidence_levels
    ]
    write_csv(output, pd.DataFrame(rows))
