"""Conformal prediction with fixed weights: calibration rows count the more, the nearer they are to what comes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.conformal import weighted_limits
from softkin.uncertainty.intervals.spec import NO_GUARANTEE
from softkin.uncertainty.labelled.spec import NO_LABELS, Answer, Labelled, LabelledMethod

#: Of two rows next to each other in rank, how much less the farther one counts.
DECAY = 0.97


def answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int) -> Answer:
    """Barber, Candes, Ramdas and Tibshirani (2023), section 2: weights DECAY^rank, the outermost command first.

    Helps where rows drift and the last ones are like the next; what lies beyond all of them it cannot know. Its loss of
    coverage is bounded by the weighted total variation between rows, which nobody knows here: no guarantee.
    """
    outwards = np.argsort(np.argsort(labelled.norm(labelled.calibration_commands), kind="stable"), kind="stable")
    weights: Array = np.power(DECAY, len(outwards) - outwards)
    halves = weighted_limits(
        np.abs(labelled.calibration_errors), weights, np.ones(len(labelled.errors)), confidence_levels
    )
    size = float(weights.sum() ** 2 / (weights**2).sum())
    everything = np.arange(len(labelled.errors))
    return Answer(halves, everything, [""] * len(confidence_levels), {"effective_size": size})


METHOD = LabelledMethod("fixed_weights", "Fixed weights", NO_LABELS, NO_GUARANTEE, answer)
