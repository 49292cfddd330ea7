"""A robot followed through time: what it remembers is kept between commands."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from softkin.core.errors import DataError
from softkin.core.samples import Array, Samples
from softkin.models.estimators.in_sessions import UNSEEN, InSessions


class Step(NamedTuple):
    """Position and the bounds of its interval, each (n_coordinates,) in mm."""

    position: Array
    lower: Array
    upper: Array


class State:
    """Where a robot is in time: its last command, what it remembers, and its session."""

    def __init__(self, robot: Any, session: int | None = None, confidence_level: float = 0.9) -> None:
        self.robot, self.levels = robot, [confidence_level]
        self.estimator = robot.estimator if isinstance(robot.estimator, InSessions) else None
        self.session = UNSEEN if session is None else float(session)
        if session is not None and (self.estimator is None or self.session not in self.estimator.sessions_):
            known = [] if self.estimator is None else [int(number) for number in self.estimator.sessions_]
            raise DataError(
                f"no session {session} in its recording ({known})",
                where=robot.dataset,
                fix="leave the session out; a new one has the average zero until it is recalibrated",
            )
        self.memory: Array | None = None
        self.last: Array | None = None

    @property
    def assumes(self) -> str:
        """What predictions from here on take for granted, in words."""
        if self.estimator is None:
            return "The command alone decides: the recording order of this robot is not known."
        rest = ", ".join(f"{value:.4g}" for value in self.estimator.robot.rest)
        memory = f"The robot was at rest at ({rest})" if self.last is None else "The robot was sent the commands so far"
        if self.session != UNSEEN:
            return f"{memory}, in session {self.session:.0f} of its recording."
        if self.robot.recalibration is not None:
            return f"{memory}, in the session whose {self.robot.recalibration.n_poses} poses were labelled."
        n_sessions = len(self.estimator.sessions_)
        return (
            f"{memory}, in a session never seen: its zero is taken as the average of {n_sessions} known, and intervals "
            "are wider by how much these differ, until a few labelled poses recalibrate it."
        )

    def inputs(self, commands: Array) -> Array:
        """What the model is given at `commands` (n_rows, n_commands), sent one after the other from here on."""
        if self.estimator is None:
            return commands
        memory = self.estimator.robot.along(commands, self.memory, self.last)
        if len(commands):
            self.memory, self.last = memory[-1], commands[-1]
        return np.column_stack([commands, memory, np.full(len(commands), self.session)])

    def step(self, command: Array) -> Step:
        """Send one command (n_commands,): position and interval."""
        inputs = self.inputs(checked_rows(command, self.robot.train, self.robot.dataset))
        predicted = self.robot.predict(inputs)
        bounds = self.robot.intervals(inputs, self.levels, predicted)[0, 0]
        return Step(predicted[0], bounds[:, 0], bounds[:, 1])


def checked_rows(commands: Array, train: Samples, where: str) -> Array:
    """Commands (n_rows, n_commands) of one row or more, or inputs (n_rows, n_inputs) of a recording like `train`.

    Raises:
        DataError: of another shape, or not finite.
    """
    rows = np.atleast_2d(np.asarray(commands, dtype=np.float64))
    n_commands = train.commands.shape[1]
    if rows.ndim != 2 or rows.shape[1] not in (n_commands, train.inputs.shape[1]) or not np.isfinite(rows).all():
        raise DataError(
            f"expected finite commands of shape (n_rows, {n_commands}), got {rows.shape}",
            where=where,
            fix=f"pass one row of {n_commands} finite numbers per pose",
        )
    return rows
