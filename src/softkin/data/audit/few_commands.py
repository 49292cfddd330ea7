"""Check for few distinct commands: many rows that repeat the same few commands."""

from __future__ import annotations

from collections.abc import Mapping

from softkin.core.rows import row_groups, stacked_commands
from softkin.core.samples import TRAIN, Array, Samples
from softkin.data.audit.findings import WARNING, CheckResult, Finding

#: Fewer distinct commands than this share of the rows of train are few.
FEW_SHARE = 0.5


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """At most one finding, on `train`, with the number of distinct commands over all subsets."""
    distinct = {subset: _distinct(rows.commands) for subset, rows in samples.items()}
    in_all = _distinct(stacked_commands(samples))
    numbers = {"distinct": distinct, "distinct_in_all_subsets": in_all}
    n_train, total = len(samples[TRAIN]), sum(map(len, samples.values()))
    if distinct[TRAIN] >= FEW_SHARE * n_train:
        return CheckResult((), numbers)
    finding = Finding(
        "few_distinct_commands",
        WARNING,
        (TRAIN,),
        f"All {total} rows hold only {in_all} distinct commands; train has {distinct[TRAIN]} in {n_train} rows.",
        f"A model learns from {distinct[TRAIN]} commands, not from {n_train}. Rows of one command must stay in one "
        "subset and in one fold, otherwise every score is training error.",
    )
    return CheckResult((finding,), numbers)


def _distinct(commands: Array) -> int:
    return int(row_groups(commands).max(initial=-1)) + 1
