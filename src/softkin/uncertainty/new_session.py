"""A session never seen: intervals are wider by how much zeros differ between the known ones; labelled poses of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.stats import t

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.models.estimators.in_sessions import InSessions
from softkin.uncertainty import calls
from softkin.uncertainty.control_loop import State


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
    zero = unseen_zero(estimator, inputs, confidence_levels)
    if zero is None:
        return bounds
    sides = bounds - predicted[..., None]
    return np.asarray(predicted[..., None] + np.sign(sides) * np.hypot(sides, zero[..., None]))


def unseen_zero(estimator: Any, inputs: Array, confidence_levels: Sequence[float]) -> Array | None:
    """How far (n_levels, n_rows, n_coordinates) in mm the zero of a session never seen lies from the average at most,
    at each level; 0 for rows of known sessions, None where there is none else.
    """
    of_unseen = zero_of_unseen(estimator, confidence_levels)
    if of_unseen is None:
        return None
    unseen = ~np.isin(estimator.inputs(inputs)[:, -1], estimator.sessions_)
    return np.asarray(of_unseen[:, None] * unseen[:, None]) if unseen.any() else None


def zero_of_unseen(estimator: Any, confidence_levels: Sequence[float]) -> Array | None:
    """The same (n_levels, n_coordinates) of any session never seen; None where fewer than two are known."""
    spread = zero_spread(estimator)
    if spread is None:
        return None
    n_sessions = len(estimator.sessions_)
    quantiles = t.ppf((1 + np.asarray(confidence_levels)) / 2, n_sessions - 1)
    return np.asarray(quantiles[:, None] * spread * np.sqrt(1 + 1 / n_sessions))


def labelled_errors(robot: Any, commands: calls.Rows, positions: calls.Rows) -> Array:
    """Measured minus predicted positions (n_poses, n_coordinates) in mm of the labelled poses of a new session.

    Raises:
        DataError: a pose lies in extrapolation, or is none.
    """
    n_commands = robot.train.commands.shape[1]
    inputs = calls.command_rows(commands, robot.names, robot.train.inputs.shape[1], robot.dataset)
    if inputs.shape[1] == n_commands:
        inputs = State(robot).inputs(inputs)
    outside = robot.is_outside(inputs)
    if outside.any():
        raise DataError(
            f"{int(outside.sum())} of {len(inputs)} commands lie in extrapolation, where errors are larger",
            where=f"{robot.dataset}, pose {int(np.argmax(outside))}",
            fix="label poses at commands like those of `train`",
        )
    bare = replace(robot, recalibration=None)
    measured = calls.position_rows(positions, robot.names, len(inputs), robot.dataset)
    return np.asarray(measured - bare.predict(inputs))
