"""Few-label recalibration: split conformal prediction calibrated on a few labelled rows of the new commands."""

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

    `by_distance`: half-widths proportional to the difficulty of `scp_distance`.
    """
    n = len(labelled.errors)
    if n <= N_LABELS:
        reason = f"{n} rows, of which {N_LABELS} would be labelled"
        no_rows = np.full((len(confidence_levels), 0, labelled.errors.shape[1]), np.inf)
        return Answer(no_rows, np.arange(0), [reason] * len(confidence_levels))
    drawn = np.random.default_rng(seed).permutation(n)
    labels, scored = drawn[:N_LABELS], np.sort(drawn[N_LABELS:])
    difficulty = np.ones(n)
    if by_distance:
        (difficulty,) = distances(labelled.train_commands, [labelled.commands])
    limits = conformal_limits(np.abs(labelled.errors[labels]) / difficulty[labels, None], confidence_levels)
    return Answer(limits[:, None] * difficulty[scored, None], scored, [""] * len(confidence_levels))


METHOD = LabelledMethod("few_labels", "Few labels", f"{N_LABELS} rows", MARGINAL, answer)
BY_DISTANCE = LabelledMethod(
    "few_labels_distance", "Few labels, by distance", f"{N_LABELS} rows", MARGINAL, partial(answer, by_distance=True)
)
