"""Mark rows of a table that leak, in a column `leak`: whoever reads a CSV alone must not take it for a test."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import pandas as pd

from softkin.core.samples import TEST, VALIDATION

MARK = "leak"


def marked(frame: pd.DataFrame, leaking: Mapping[str, Collection[str]], *, calibrated: bool = False) -> pd.DataFrame:
    """The table with a column `leak`, true where rows of its subset stand in train (`leaking`: dataset -> subsets).

    A table without a column `subset` is one of test rows. A number of `calibrated` intervals leaks where `validation`
    does, too: they were calibrated on rows that the model was fitted to.
    """
    subsets = frame["subset"] if "subset" in frame else pd.Series(TEST, index=frame.index)
    marks = [
        subset in leaking.get(dataset, ()) or (calibrated and VALIDATION in leaking.get(dataset, ()))
        for dataset, subset in zip(frame["dataset"], subsets, strict=True)
    ]
    return frame.assign(**{MARK: pd.Series(marks, index=frame.index, dtype=bool)})
