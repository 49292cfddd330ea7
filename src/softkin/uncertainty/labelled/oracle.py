"""The oracle: split conformal prediction calibrated on the rows that it is scored on, each left out in turn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.intervals.spec import MARGINAL
from softkin.uncertainty.labelled.spec import ALL_LABELS, Answer, Labelled, LabelledMethod


def answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int) -> Answer:
    """The calibrated interval of nearly constant width that all labels allow, the measure of all other methods.

    Infinite where there are too few rows.
    """
    scores = np.abs(labelled.errors)
    halves = np.stack([_others_limits(scores, level) for level in confidence_levels])
    return Answer(halves, np.arange(len(scores)), [""] * len(confidence_levels))


def _others_limits(scores: Array, level: float) -> Array:
    """Conformal limit (n_rows, n_columns) of the scores (n_rows, n_columns) of all other rows."""
    rank = conformal_rank(len(scores) - 1, level)
    if rank is None:
        return np.full(scores.shape, np.inf)
    ordered = np.sort(scores, axis=0)
    return np.asarray(np.where(scores <= ordered[rank - 1], ordered[rank], ordered[rank - 1]))


METHOD = LabelledMethod("oracle", "Oracle", ALL_LABELS, MARGINAL, answer)
