"""Check for duplicate rows: command and pose equal, bit for bit, those of an earlier row of the same subset."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import repeats_an_earlier_row, row_groups
from softkin.core.samples import TRAIN, Samples
from softkin.data.audit.findings import NOTE, WARNING, CheckResult, finding_of_rows

#: From this share of all rows on, duplicates are a warning, since they weigh in a fit; below, they are a note.
WARNING_SHARE = 0.01


def duplicates(rows: Samples) -> NDArray[np.bool_]:
    """Mask (n_rows,) of the rows that repeat an earlier one."""
    return repeats_an_earlier_row(row_groups(np.hstack([rows.commands, rows.positions])))


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """At most one finding, on all subsets."""
    marked = {subset: duplicates(rows) for subset, rows in samples.items()}
    counts = {subset: int(mask.sum()) for subset, mask in marked.items()}
    if not any(counts.values()):
        return CheckResult((), {"rows": counts})
    copies, total = sum(counts.values()), sum(map(len, samples.values()))
    finding = finding_of_rows(
        "duplicate_rows",
        WARNING if copies / total >= WARNING_SHARE else NOTE,
        marked,
        f"{copies} of {total} rows are copies, in command and pose, of an earlier row of the same subset "
        f"({counts[TRAIN]} of them in train).",
        "Copies add weight and no information: the dataset is smaller than its number of rows says, and "
        "cross-validation must keep copies in one fold, as softkin does.",
    )
    return CheckResult((finding,), {"rows": counts})
