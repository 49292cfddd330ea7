"""Check for so few blocks in the calibration set that nothing can be promised of new ones."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from softkin.core.samples import VALIDATION, Samples
from softkin.data.audit.findings import WARNING, CheckResult, Finding, counted

#: Blocks with which intervals of 90 % are promised.
ENOUGH = 9


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """At most one finding, on `validation`: K blocks promise a level of at most K / (K + 1).

    Source: Lee, Barber and Willett (2023); Dunn, Wasserman and Ramdas (2022).
    """
    block = samples[VALIDATION].block
    if block is None:
        return CheckResult((), {"not_measured": "rows were split one by one"})
    n_blocks = len(np.unique(block))
    highest = n_blocks / (n_blocks + 1) if n_blocks > 1 else 0.0
    numbers = {"calibration_blocks": n_blocks, "highest_level": highest}
    if n_blocks >= ENOUGH:
        return CheckResult((), numbers)
    finding = Finding(
        "few_calibration_blocks",
        WARNING,
        (VALIDATION,),
        f"Validation has {counted(n_blocks, 'block')} of rows that were split as wholes, so intervals at 90 % have no "
        f"guarantee: that takes {ENOUGH}.",
        "Rows of one block are alike, and a new block may differ from all of these. Split by `time`, or record more "
        "trials, so that more blocks are held out.",
    )
    return CheckResult((finding,), numbers)
