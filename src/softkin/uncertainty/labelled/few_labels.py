"""Calibrated on a few labelled rows out there: what an afternoon of measuring buys."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from softkin.uncertainty.conformal import conformal_limits
from softkin.uncertainty.intervals.spec import MARGINAL
from softkin.uncertainty.intervals.split_conformal_distance import distances
from softkin.uncertainty.labelled.spec import Answer, Labelled, LabelledMethod

N_LABELS = 20


def answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int, *, by_distance: bool = False) -> Answer:
    """Split conformal prediction calibrated on `N_LABELS` rows, drawn with the seed; the others are scored.

    `by_distance`: wider where the command is far from those of `train`, as `scp_distance` is.
    """
    n = len(labelled.errors)
    if n <= N_LABELS:
        reason = f"{n} rows, of which {N_LABELS} would be labelled"
        nothing = np.full((len(confidence_levels), 0, labelled.errors.shape[1]), np.inf)
        return Answer(nothing, np.arange(0), [reason] * len(confidence_levels))
    drawn = np.random.default_rng(seed).permutation(n)
    known, scored = drawn[:N_LABELS], np.sort(drawn[N_LABELS:])
    difficulty = np.ones(n)
    if by_distance:
        (difficulty,) = distances(labelled.train_commands, [labelled.commands])
    limits = conformal_limits(np.abs(labelled.errors[known]) / difficulty[known, None], confidence_levels)
    return Answer(limits[:, None] * difficulty[scored, None], scored, [""] * len(confidence_levels))


METHOD = LabelledMethod("few_labels", "Few labels", f"{N_LABELS} rows", MARGINAL, answer)
BY_DISTANCE = LabelledMethod(
    "few_labels_distance", "Few labels, by distance", f"{N_LABELS} rows", MARGINAL, partial(answer, by_distance=True)
)
