"""Clean `train`: drop its stuck and duplicate rows. No other subset is read or changed."""

from __future__ import annotations

from collections.abc import Mapping

from softkin.core.samples import TRAIN, Samples, informative_coordinates
from softkin.data.audit.duplicate_rows import duplicates
from softkin.data.audit.stuck_poses import stuck


def cleaned(samples: Mapping[str, Samples]) -> tuple[dict[str, Samples], dict[str, int]]:
    """`samples` without the stuck and the duplicate rows of `train`, and how many of each were removed.

    Only rows of `train` count: a row that shares its pose with a row of another subset alone stays, since a model must
    not learn from other subsets. A row that is both counts as stuck.
    """
    train = samples[TRAIN]
    moving = informative_coordinates(train.positions)
    is_stuck = stuck(train.commands, train.positions[:, moving])[0]
    is_copy = duplicates(train) & ~is_stuck
    kept = ~(is_stuck | is_copy)
    removed = {"stuck_rows": int(is_stuck.sum()), "duplicate_rows": int(is_copy.sum())}
    return {**samples, TRAIN: train.take(kept)}, removed
