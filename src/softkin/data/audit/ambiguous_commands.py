"""Check for commands that do not determine the pose: at (nearly) equal commands poses differ by far more than noise.

Noise is what the nearest poses at equal commands differ by: a robot with backlash or another zero has poses in several
bunches at a command, so that some pairs of them are near and others far apart; noise alone has pairs of all distances.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import command_scale, row_groups, sampled_rows, stacked_commands, stacked_positions
from softkin.core.samples import TRAIN, Array, Samples, informative_coordinates
from softkin.data.audit.findings import WARNING, CheckResult, Finding

#: Commands nearer than this (standard deviations on `train`) are nearly equal.
NEARLY_EQUAL = 0.01
#: Poses differ by far more than the noise where nine tenths of the pairs' distance is so many times one tenth's, of a
#: single coordinate the second number (normal noise: 3 to 5, and 13), and more than this share of the extent.
FAR, FAR_ALONE, FAR_SHARE = 15.0, 40.0, 0.02
FEWEST_PAIRS, MAX_PAIRS, MAX_ROWS = 30, 20_000, 20_000
Pairs = NDArray[np.int64]


def check(samples: Mapping[str, Samples], seed: int = 0) -> CheckResult:
    """At most one finding, on all subsets."""
    moving = informative_coordinates(samples[TRAIN].positions)
    if not moving.any():
        return CheckResult((), {"not_measured": "no coordinate moves"})
    rows = sampled_rows(sum(map(len, samples.values())), MAX_ROWS, seed)
    commands, positions = stacked_commands(samples)[rows], stacked_positions(samples, moving)[rows]
    pairs = _pairs(commands, command_scale(samples[TRAIN].commands), seed)
    if len(pairs) < FEWEST_PAIRS:
        return CheckResult((), {"not_measured": f"fewer than {FEWEST_PAIRS} pairs of nearly equal commands"})
    differences = positions[pairs[:, 0]] - positions[pairs[:, 1]]
    distances = np.linalg.norm(differences, axis=1)
    near, far = (float(value) for value in np.quantile(distances, (0.1, 0.9)))
    extent = float(np.linalg.norm(np.ptp(positions, axis=0)))
    numbers: dict[str, Any] = {"pairs": len(pairs), "near_mm": near, "far_mm": far}
    if far <= max((FAR if moving.sum() > 1 else FAR_ALONE) * near, FAR_SHARE * extent):
        return CheckResult((), numbers)
    finding = Finding(
        "command_does_not_determine_pose",
        WARNING,
        tuple(samples),
        f"At (nearly) equal commands poses lie {far:.2g} mm apart (a tenth of {len(pairs)} pairs farther still), while "
        f"the nearest tenth agrees to {near:.2g} mm: that is no noise.",
        "No model of the command alone errs by less than half of that. The robot remembers (hysteresis, creep), was in "
        "another state, or its zero was another: name `order` and `session` in the entry, so that models with memory "
        "and zeros of sessions are tried, and split the recording by time.",
    )
    return CheckResult((finding,), numbers)


def _pairs(commands: Array, scale: Array, seed: int) -> Pairs:
    """Pairs (n_pairs, 2) of rows of equal commands; where these are few, of each row and its nearest command."""
    from sklearn.neighbors import NearestNeighbors

    groups = row_groups(commands)
    order = np.random.default_rng(seed).permutation(len(groups))
    order = order[np.argsort(groups[order], kind="stable")]
    equal = []
    for step in range(1, 13):
        ahead = groups[order[step:]] == groups[order[:-step]]
        equal.append(np.column_stack([order[:-step][ahead], order[step:][ahead]]))
    pairs = np.concatenate(equal)
    if len(pairs) < FEWEST_PAIRS and len(commands) > 1:
        distances, nearest = NearestNeighbors(n_neighbors=2).fit(commands / scale).kneighbors()
        close = distances[:, 0] <= NEARLY_EQUAL
        pairs = np.column_stack([np.flatnonzero(close), nearest[close, 0]])
    return pairs[sampled_rows(len(pairs), MAX_PAIRS, seed)]
