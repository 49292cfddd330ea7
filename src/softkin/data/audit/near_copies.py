"""Check for near copies: rows of the other subsets whose command is almost one of `train`.

Near is measured against the spacing of train around the nearest train command. Where train itself comes in tight
bunches (one command repeated with jitter), that is the distance to the next bunch, which shows as a gap in the sorted
distances to its neighbours. Distances are Euclidean, in standard deviations of each command on train.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import command_scale, first_of_each, row_groups, sampled_rows
from softkin.core.samples import TRAIN, Array, Samples
from softkin.data.audit.copied_commands import MEASURED_ANEW
from softkin.data.audit.findings import LEAK, LEAK_CONSEQUENCES, WARNING, CheckResult, Finding, finding_of_rows

if TYPE_CHECKING:
    from sklearn.neighbors import NearestNeighbors

#: A command nearer than this share of the local spacing is a near copy.
NEAR_SHARE = 0.01
#: A neighbour that is this many times farther than the one before starts the next bunch; this many are compared.
GAP, N_NEIGHBOURS = 10.0, 256
#: A pose repeats one of `train` where no coordinate differs by more than this share of its extent there.
SAME_POSE = 1e-3
#: By chance, at most this share of independent rows is so near (with a single command; rarer with more). More rows than
#: chance brings in one of a million datasets are a leak.
CHANCE_SHARE, CHANCE_OF_FALSE_ALARM = 0.02, 1e-6
MAX_TRAIN_COMMANDS, MAX_ROWS_CHECKED = 100_000, 2_000


def check(samples: Mapping[str, Samples], seed: int = 0) -> CheckResult:
    """A finding for each subset with too many near copies; exact copies are left to their own check."""
    from scipy.stats import binom
    from sklearn.neighbors import NearestNeighbors

    train = samples[TRAIN].commands
    scale = command_scale(train)
    first = first_of_each(row_groups(train))
    first = first[sampled_rows(len(first), MAX_TRAIN_COMMANDS, seed)]
    distinct, extent = train[first] / scale, np.ptp(samples[TRAIN].positions, axis=0)
    numbers: dict[str, Any] = {"train_commands_looked_at": len(distinct), "unit": "standard deviations on train"}
    if len(distinct) < 3:
        return CheckResult((), numbers | {"not_measured": "train has fewer than 3 distinct commands"})
    tree = NearestNeighbors().fit(distinct)
    typical = distinct[sampled_rows(len(distinct), MAX_ROWS_CHECKED, seed)]
    numbers["typical_spacing"] = float(np.median(_spacing(tree, typical)))
    findings = []
    for subset, consequence in LEAK_CONSEQUENCES.items():
        checked = sampled_rows(len(samples[subset]), MAX_ROWS_CHECKED, seed)
        distances, nearest = tree.kneighbors(samples[subset].commands[checked] / scale, n_neighbors=1)
        distances = distances[:, 0]
        spacing = _spacing(tree, distinct[nearest[:, 0]])
        near = (distances > 0) & (distances < NEAR_SHARE * spacing)
        count, total = int(near.sum()), len(checked)
        moved = np.abs(samples[subset].positions[checked] - samples[TRAIN].positions[first[nearest[:, 0]]])
        repeats = near & (moved <= SAME_POSE * extent).all(axis=1)
        numbers[subset] = {
            "rows_looked_at": total,
            "near_copies": count,
            "poses_repeated": int(repeats.sum()),
            "nearest_distance_min": float(distances.min()),
            "nearest_distance_median": float(np.median(distances)),
        }
        if count > binom.isf(CHANCE_OF_FALSE_ALARM, total, CHANCE_SHARE):
            marked = np.zeros(len(samples[subset]), dtype=bool)
            marked[checked[near]] = True
            is_leak = repeats.sum() > binom.isf(CHANCE_OF_FALSE_ALARM, total, CHANCE_SHARE)
            findings.append(_finding(subset, marked, total, consequence if is_leak else None))
    return CheckResult(tuple(findings), numbers)


def _finding(subset: str, marked: NDArray[np.bool_], total: int, leak: str | None) -> Finding:
    """The finding on marked rows (n_rows,) of a subset; `leak` is what follows where poses repeat, too."""
    count, how = int(marked.sum()), "measured anew" if leak is None else "with its pose"
    return finding_of_rows(
        "near_copied_commands",
        WARNING if leak is None else LEAK,
        {subset: marked},
        f"Of {total} rows of {subset} that were looked at, {count} ({count / total:.1%}) lie nearer to "
        f"a train command than a hundredth of the spacing of train commands there, {how}.",
        f"{leak or MEASURED_ANEW} The commands differ by next to nothing, as if one command had been repeated with "
        "jitter and its repetitions spread over the subsets.",
    )


def _spacing(tree: NearestNeighbors, commands: Array) -> Array:
    """Distance (n_rows,) from each of `commands`, themselves in the tree, to the nearest one beyond their bunch."""
    n = min(N_NEIGHBOURS, tree.n_samples_fit_)
    distances = tree.kneighbors(commands, n_neighbors=n)[0][:, 1:]
    ratios = distances[:, 1:] / np.maximum(distances[:, :-1], np.finfo(float).tiny)
    place = np.where(ratios.max(axis=1) > GAP, ratios.argmax(axis=1) + 1, 0)
    return np.asarray(np.take_along_axis(distances, place[:, None], axis=1)[:, 0])
