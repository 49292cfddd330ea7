"""Conformal prediction with fixed weights: calibration rows of larger command norm count more."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.conformal import weighted_limits
from softkin.uncertainty.intervals.spec import NO_GUARANTEE
from softkin.uncertainty.labelled.spec import NO_LABELS, Answer, Labelled, LabelledMethod

#: Weight of a row over that of the next one in ascending order of command norm.
DECAY = 0.97


def answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int) -> Answer:
    """Barber, Candes, Ramdas and Tibshirani (2023), section 2: weights DECAY^rank, the largest norm first.

    It helps where rows drift and the last ones are like the next ones. Its loss of coverage is bounded by the weighted
    total variation between rows, which is unknown here: no guarantee.
    """
    outwards = np.argsort(np.argsort(labelled.norm(labelled.calibration_commands), kind="stable"), kind="stable")
    weights: Array = np.power(DECAY, len(outwards) - outwards)
    halves = weighted_limits(
        np.abs(labelled.calibration_errors), weights, np.ones(len(labelled.errors)), confidence_levels
    )
    size = float(weights.sum() ** 2 / (weights**2).sum())
    all_rows = np.arange(len(labelled.errors))
    return Answer(halves, all_rows, [""] * len(confidence_levels), {"effective_size": size})


METHOD = LabelledMethod("fixed_weights", "Fixed weights", NO_LABELS, NO_GUARANTEE, answer)
