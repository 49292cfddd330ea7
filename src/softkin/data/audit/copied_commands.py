"""Check for copied commands: rows of the other subsets whose command stands, bit for bit, in `train`."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from softkin.core.rows import row_groups, split_by_subset, stacked_commands
from softkin.core.samples import TRAIN, Samples
from softkin.data.audit.findings import LEAK, LEAK_CONSEQUENCES, WARNING, CheckResult, finding_of_rows

#: From this share of a subset's rows on, copies are a leak: its score is training error. Below, they are a warning.
LEAK_SHARE = 0.01


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """A finding for each subset with copies."""
    groups = row_groups(stacked_commands(samples))
    by_subset = split_by_subset(groups, samples)
    findings, numbers = [], {}
    for subset, consequence in LEAK_CONSEQUENCES.items():
        copied = np.isin(by_subset[subset], by_subset[TRAIN])
        count, total = int(copied.sum()), len(copied)
        numbers[subset] = {"rows": count, "share": count / total}
        if count:
            findings.append(
                finding_of_rows(
                    "copied_commands",
                    LEAK if count / total >= LEAK_SHARE else WARNING,
                    {subset: copied},
                    f"{count} of {total} rows of {subset} ({count / total:.1%}) have a command that stands exactly in "
                    "train.",
                    consequence,
                )
            )
    return CheckResult(tuple(findings), numbers)
