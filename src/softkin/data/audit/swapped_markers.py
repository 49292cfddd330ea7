"""Check for swapped markers: rows whose distances between markers an exchange of labels puts right."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from softkin.core.samples import TRAIN, Samples
from softkin.data.audit.findings import WARNING, CheckResult, counted, finding_of_rows
from softkin.data.marker_order import FEWEST_MARKERS, is_swapped, orders_of

MAX_MARKERS, FEWEST_ROWS = 24, 20


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """At most one finding, on all subsets."""
    n_markers = samples[TRAIN].positions.shape[1] // 3
    if not FEWEST_MARKERS <= n_markers <= MAX_MARKERS or len(samples[TRAIN]) < FEWEST_ROWS:
        return CheckResult(
            (), {"not_measured": f"{FEWEST_MARKERS} to {MAX_MARKERS} markers and {FEWEST_ROWS} rows are needed"}
        )
    orders = {subset: orders_of(rows.positions, samples[TRAIN].positions) for subset, rows in samples.items()}
    marked = {subset: is_swapped(order) for subset, order in orders.items()}
    numbers = {"rows": {subset: int(mask.sum()) for subset, mask in marked.items()}}
    if not any(numbers["rows"].values()):
        return CheckResult((), numbers)
    moved = np.concatenate([order[marked[subset]] for subset, order in orders.items()]) != np.arange(n_markers)
    names = ", ".join(f"m{place + 1}" for place in np.flatnonzero(moved.any(axis=0)))
    finding = finding_of_rows(
        "swapped_markers",
        WARNING,
        marked,
        f"{counted(sum(numbers['rows'].values()), 'row')} have distances between markers that an exchange of labels "
        f"puts right, among {names}.",
        "The tracker mixed up its markers there, and a model learns the mean of both. relabel: true in the entry mends "
        "these rows in every subset and counts them.",
    )
    return CheckResult((finding,), numbers)
