"""Intervals in a session never seen: wider by how much zeros differ between the sessions that are known."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.stats import t

from softkin.core.samples import Array
from softkin.models.estimators.in_sessions import InSessions


def zero_spread(estimator: Any) -> Array | None:
    """Standard deviation (n_coordinates,) in mm of zeros between sessions; None where fewer than two are known."""
    if not isinstance(estimator, InSessions) or not estimator.zeros or len(estimator.sessions_) < 2:
        return None
    return np.asarray(estimator.zeros_.std(axis=0, ddof=1))


def widened(
    bounds: Array, predicted: Array, estimator: Any, inputs: Array, confidence_levels: Sequence[float]
) -> Array:
    """Bounds (n_levels, n_rows, n_coordinates, 2) with the zero of a session never seen in them, which is drawn like
    those of the known ones: Student's t, as there are few. Rows of known sessions stay as they are.

    Parameters:
        bounds: of rows in a known session.
        predicted: positions (n_rows, n_coordinates) in mm.
        estimator: knows the sessions.
        inputs: of the rows; bare commands are of no known session.
        confidence_levels: of the bounds.
    """
    spread = zero_spread(estimator)
    if spread is None:
        return bounds
    n_sessions = len(estimator.sessions_)
    unseen = ~np.isin(estimator.inputs(inputs)[:, -1], estimator.sessions_)
    if not unseen.any():
        return bounds
    quantiles = t.ppf((1 + np.asarray(confidence_levels)) / 2, n_sessions - 1)
    zero = quantiles[:, None, None] * spread * np.sqrt(1 + 1 / n_sessions) * unseen[:, None]
    sides = bounds - predicted[..., None]
    return np.asarray(predicted[..., None] + np.sign(sides) * np.hypot(sides, zero[..., None]))
