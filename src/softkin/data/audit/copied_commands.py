"""Check for copied commands: rows of the other subsets whose command stands, bit for bit, in `train`.

Where the pose stands there too, the score of such a row is training error, a leak. Where the robot was measured anew at
an old command, as it is when a recording that repeats commands is split by time, the pose is news and the command is
not: that is a warning.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.metrics.point import euclidean_errors
from softkin.core.rows import row_groups, split_by_subset, stacked_commands
from softkin.core.samples import TRAIN, Array, Samples
from softkin.data.audit.findings import LEAK, LEAK_CONSEQUENCES, NOTE, WARNING, CheckResult, Finding, finding_of_rows

#: From this share of a subset's rows on, copies are a leak: its score is training error. Below, they are a warning.
LEAK_SHARE = 0.01
MEASURED_ANEW = (
    "Their score says how well poses repeat, in noise and drift, and not how well a model predicts commands that it "
    "was not fitted to. A split by time keeps the order of rows and lets commands repeat; the split `random` keeps "
    "rows of one command together."
)


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """A finding for each subset with copies, and one for each with new poses at commands of `train`."""
    groups = split_by_subset(row_groups(stacked_commands(samples)), samples)
    wholes = split_by_subset(
        row_groups(np.vstack([np.hstack([rows.commands, rows.positions]) for rows in samples.values()])), samples
    )
    findings, numbers = [], {}
    for subset, consequence in LEAK_CONSEQUENCES.items():
        known = np.isin(groups[subset], groups[TRAIN])
        copied = np.isin(wholes[subset], wholes[TRAIN])
        count, total = int(known.sum()), len(known)
        numbers[subset] = {"rows": count, "share": count / total, "poses_repeated": int(copied.sum())}
        if copied.any():
            share = copied.mean()
            findings.append(
                finding_of_rows(
                    "copied_commands",
                    LEAK if share >= LEAK_SHARE else WARNING,
                    {subset: copied},
                    f"{int(copied.sum())} of {total} rows of {subset} ({share:.1%}) have a command that stands exactly "
                    "in train, with the same pose.",
                    consequence,
                )
            )
        anew = known & ~copied
        if anew.any():
            moved = _moved(samples[subset].take(anew), samples[TRAIN], groups[subset][anew], groups[TRAIN])
            findings.append(_measured_anew(subset, anew, moved))
    return CheckResult(tuple(findings), numbers)


def _measured_anew(subset: str, anew: NDArray[np.bool_], moved: Array) -> Finding:
    """The finding on the rows of a mask (n_rows,) whose poses lie so far off, (n_marked,) in mm."""
    count, total = int(anew.sum()), len(anew)
    return finding_of_rows(
        "repeated_commands",
        WARNING if count / total >= LEAK_SHARE else NOTE,
        {subset: anew},
        f"{count} of {total} rows of {subset} ({count / total:.1%}) have a command that stands exactly in train, "
        f"measured anew: the pose differs from the mean pose there by {np.median(moved):.2g} mm (median).",
        MEASURED_ANEW,
    )


def _moved(rows: Samples, train: Samples, codes: NDArray[Any], train_codes: NDArray[Any]) -> Array:
    """How far (n_rows,) the farthest marker of each row lies from the mean pose of `train` at its command, mm."""
    means = pd.DataFrame(train.positions).groupby(train_codes).mean()
    return np.asarray(euclidean_errors(means.loc[codes].to_numpy(), rows.positions).max(axis=1))
