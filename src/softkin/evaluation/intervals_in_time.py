"""Half-widths of intervals on rows in the order of their recording, and the parts of time that they are scored on."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from softkin.core.rows import Indices
from softkin.core.samples import Array
from softkin.evaluation.recorded_names import ADAPTIVE, FIXED_WEIGHTS, PLAIN
from softkin.uncertainty.conformal import conformal_limits, weighted_limits
from softkin.uncertainty.labelled.adaptive import trajectory
from softkin.uncertainty.labelled.fixed_weights import DECAY

N_BLOCKS = 4


def after(known: Array, new: Array, level: float) -> dict[str, Array]:
    """Method -> half-widths (n_new or 1, n_coordinates) in mm on rows after those that are calibrated on.

    Split conformal prediction; adaptive inference, whose rows are measured one by one; and fixed weights, whose
    calibration rows count the more the later they were recorded. `known` and `new` (n_rows, n_coordinates) are absolute
    errors in mm, in the order of time.
    """
    weights = DECAY ** np.arange(len(known), 0, -1.0)
    return {
        PLAIN: conformal_limits(known, [level]),
        ADAPTIVE: _finite(trajectory(known, new, level), known),
        FIXED_WEIGHTS: weighted_limits(known, weights, np.ones(1), [level])[0],
    }


def among(known: Array, known_order: Indices, new: Array, order: Indices, level: float) -> dict[str, Array]:
    """As `after`, on rows among those that are calibrated on: fixed weights fade with the number of calibration rows
    that were recorded between, before or after. `known_order` and `order` (n_rows,) are ascending.
    """
    places = np.arange(len(known))
    halves = [
        weighted_limits(known, DECAY ** np.abs(places - place), np.ones(1), [level])[0][0]
        for place in np.searchsorted(known_order, order) - 0.5
    ]
    return {
        PLAIN: conformal_limits(known, [level]),
        ADAPTIVE: _finite(trajectory(known, new, level), known),
        FIXED_WEIGHTS: np.array(halves),
    }


def blocks(n_rows: int) -> Iterator[tuple[str, Indices]]:
    """Name and rows of each of `N_BLOCKS` stretches of time of the same length."""
    for place, rows in enumerate(np.array_split(np.arange(n_rows), N_BLOCKS), start=1):
        if len(rows):
            yield f"block {place} of {N_BLOCKS}", rows


def _finite(halves: Array, known: Array) -> Array:
    """Where a level has left 0 to 1 it asks for everything: the widest calibration error stands for it in means."""
    return np.where(np.isfinite(halves), halves, known.max(axis=0))
