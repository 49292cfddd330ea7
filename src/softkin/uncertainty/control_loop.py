"""A robot followed through time: what it remembers is kept between commands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.models.estimators.in_sessions import UNSEEN, InSessions
from softkin.uncertainty import calls
from softkin.uncertainty.chance_and_time import session_of


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
        known = [] if self.estimator is None else list(self.estimator.sessions_)
        self.session = UNSEEN if session is None else session_of(session, known, robot.dataset)
        self.halves: Array | float = 0.0 if self.estimator is None else self.estimator.robot.half_widths()
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

    def inputs(self, commands: calls.Rows) -> Array:
        """What the model is given at `commands` (n_rows, n_commands), sent one after the other from here on.

        Raises:
            DataError: they are no such commands; nothing is sent.
        """
        return self._after(self._checked(commands))

    def input_of(self, command: calls.Rows) -> Array:
        """The same (1, n_inputs) of one command (n_commands,).

        Raises:
            DataError: it is no command, or several; nothing is sent.
        """
        rows = self._checked(command)
        if len(rows) != 1:
            raise DataError(
                f"{len(rows)} commands, where one is sent at a time",
                where=self.robot.dataset,
                fix="send them one after the other, or all at once with follow()",
            )
        return self._after(rows)

    def next_inputs(self, commands: Array) -> Array:
        """What the model is given at each of `commands` (n_rows, n_commands) if it were the next; none is sent."""
        if self.estimator is None:
            return commands
        memory = self.estimator.robot.next_after(commands, self.memory, self.last)
        return np.column_stack([commands, memory, np.full(len(commands), self.session)])

    def step(self, command: calls.Rows) -> Step:
        """Send one command (n_commands,): position and interval."""
        inputs = self.input_of(command)
        predicted = self.robot._predicted(inputs)
        bounds = self.robot._bounds(inputs, self.levels, predicted)[0, 0]
        return Step(predicted[0], bounds[:, 0], bounds[:, 1])

    def _checked(self, commands: calls.Rows) -> Array:
        n_commands = self.robot.train.commands.shape[1]
        return calls.command_rows(commands, self.robot.names, n_commands, self.robot.dataset)

    def _after(self, commands: Array) -> Array:
        """The inputs of commands that are checked; what the robot remembers then is kept."""
        before, self.last = self.last, commands[-1]
        if self.estimator is None:
            return commands
        if len(commands) == 1:
            return self._after_one(commands[0], self.estimator.robot.rest if before is None else before)
        memory = self.estimator.robot.along(commands, self.memory, before)
        self.memory = memory[-1]
        return np.column_stack([commands, memory, np.full(len(commands), self.session)])

    def _after_one(self, command: Array, previous: Array) -> Array:
        """The same of one command (n_commands,), without what many need."""
        n, halves = len(command), self.halves
        plays = previous if self.memory is None else self.memory[n:].reshape(-1, n)
        moved = np.minimum(np.maximum(plays, command - halves), command + halves)
        inputs = np.concatenate([command, previous, moved.ravel(), [self.session]])
        self.memory = inputs[n:-1]
        return inputs[None]


def error_of(state: State, moving: NDArray[np.bool_]) -> Callable[[calls.Rows, calls.Rows], Array]:
    """error(command, position), measured minus predicted position (n_moving,) in mm of the commands sent to `state`, of
    the moving coordinates.
    """
    robot = state.robot

    def error(command: calls.Rows, position: calls.Rows) -> Array:
        measured = calls.position_rows(position, robot.names, 1, robot.dataset)
        return np.asarray((measured - robot.predict(state.input_of(command)))[0, moving])

    return error
