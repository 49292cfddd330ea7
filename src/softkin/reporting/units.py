"""Units of the datasets of a run in its tables: a robot in a unit of its own is never headed by mm.

Columns keep their names (`rmse_mm`, `mean_width_mm`). Where a dataset of the run is not in mm, each table with a column
`dataset` has a column `unit` too, and that is what such columns are in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from softkin.core.units import MM, heading, unit_of

UNIT = "unit"


def with_units(
    frames: Mapping[str, pd.DataFrame], descriptions: Sequence[Mapping[str, Any]]
) -> dict[str, pd.DataFrame]:
    """The tables of a run, by name, with a column `unit` where a dataset is not in mm.

    Parameters:
        frames: name -> table.
        descriptions: of the datasets.
    """
    units = {about["dataset"]: unit_of(about) for about in descriptions}
    if all(unit == MM for unit in units.values()):
        return dict(frames)
    return {
        name: frame.assign(**{UNIT: frame["dataset"].map(units)}) if "dataset" in frame else frame
        for name, frame in frames.items()
    }


def units_in(frame: pd.DataFrame) -> dict[str, str]:
    """Dataset -> unit of its lengths in a table."""
    units = frame[UNIT] if UNIT in frame else [MM] * len(frame)
    return dict(zip(frame["dataset"], units, strict=True))


def heading_of(frame: pd.DataFrame) -> str:
    """What heads lengths in a table of several datasets: 'mm', 'px', or 'mm or px'."""
    return heading(units_in(frame).values())


def told(units: Mapping[str, str]) -> dict[str, str]:
    """Dataset -> what is said of its unit where those of a run differ, of each that is not in mm: 'in px'."""
    differ = len(set(units.values())) > 1
    return {dataset: f"in {unit}" for dataset, unit in units.items() if differ and unit != MM}
