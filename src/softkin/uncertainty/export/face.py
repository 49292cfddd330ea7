"""What a caller of an exported Python file sees, by numpy alone. Exported Python files hold a copy of this text."""

from __future__ import annotations

import base64
import json
import zlib
from typing import Any

import numpy as np

from softkin.models.plain.kernels import Node, Values
from softkin.uncertainty.plain.may_fail import MayFail
from softkin.uncertainty.plain.robot import PlainRobot

#: Arithmetic on larger numbers overflows.
LARGEST = 1e100


class Model:
    """Positions, intervals at the stored levels and `outside`, of commands (n_rows, n_commands) or one (n_commands,).

    Answers are in mm, or the unit of its `numbers`. A robot that remembers is taken to be sent each command from rest,
    in a session never seen; `start` follows it through time.
    """

    def __init__(self, numbers: Node) -> None:
        self.robot, self.levels = PlainRobot(numbers), [float(level) for level in numbers["levels"]]
        self.numbers, failures = numbers, numbers["failures"]
        self.failures = None if failures is None else MayFail(failures)

    def predict(self, commands: Any) -> Values:
        """Positions (n_rows, n_coordinates)."""
        return self.robot.placed(self._checked(commands))[0]

    def intervals(self, commands: Any, level: float = 0.9) -> Values:
        """Lower and upper bounds (n_rows, n_coordinates, 2) at one of the `levels`."""
        return self._answer(self._checked(commands), self._place(level))[1]

    def is_outside(self, commands: Any) -> Any:
        """Which commands (n_rows,) lie where nothing is promised."""
        rows = self._checked(commands)
        return self.robot.outside(rows, self.robot.norms(rows))

    def failure_probability(self, commands: Any) -> Values | None:
        """Probability (n_rows,) that the pose fails; None: no failures are known that commands foretell."""
        rows = self._checked(commands)
        return None if self.failures is None else self.failures.probability(rows)

    def may_fail(self, commands: Any, level: float = 0.9) -> Any:
        """Which commands (n_rows,) fail with more than 1 - level: there, intervals hold failed poses, too."""
        rows, place = self._checked(commands), self._place(level)
        return np.zeros(len(rows), dtype=bool) if self.failures is None else self.failures.at(rows, place)

    def start(self, session: int | None = None, level: float = 0.9) -> Loop:
        """The robot at rest, for a control loop: `loop.step(command)`."""
        known = [] if self.robot.memory is None else [int(one) for one in self.robot.memory["sessions"]]
        if session is not None and session not in known:
            raise ValueError(f"no session {session} in its recording ({known}); leave the session out")
        return Loop(self, 0 if session is None else session, self._place(level))

    def _answer(self, inputs: Values, place: int) -> tuple[Values, Values]:
        table = self.numbers["tables"][place]
        positions, spread = self.robot.placed(inputs)
        commands = inputs[:, : self.numbers["n_commands"]]
        norms = self.robot.norms(commands)
        bounds = self.robot.in_domain(inputs, positions, spread, table)
        outside = self.robot.outside(commands, norms)
        bounds = self.robot.everywhere(bounds, positions, outside, norms, table)[0]
        return positions, bounds if self.failures is None else self.failures.widened(bounds, commands, place)

    def _checked(self, commands: Any) -> Values:
        rows, n_commands = np.atleast_2d(np.asarray(commands)), self.numbers["n_commands"]
        if rows.dtype.kind not in "iuf" or rows.ndim != 2 or rows.shape[1] != n_commands or not len(rows):
            raise ValueError(f"expected numbers of shape (n_rows, {n_commands}), got {rows.dtype} of {rows.shape}")
        rows = rows.astype(np.float64)
        if not (np.abs(rows) <= LARGEST).all():
            raise ValueError(f"row {int(np.argmin((np.abs(rows) <= LARGEST).all(axis=1)))} has no finite number")
        return rows

    def _place(self, level: float) -> int:
        if level not in self.levels:
            raise ValueError(f"{level!r} is none of the stored levels {self.levels}; export the model with it")
        return self.levels.index(level)


class Loop:
    """A robot followed through time, from rest."""

    def __init__(self, model: Model, session: int, place: int) -> None:
        self.model, self.session, self.place, self.memory = model, float(session), place, model.robot.memory
        if self.memory is not None:
            self.previous = self.memory["rest"]
            self.plays = np.tile(self.previous, (len(self.memory["halves"]), 1))

    def step(self, command: Any) -> tuple[Values, Values, Values]:
        """Send one command (n_commands,): position, lower and upper bound, each (n_coordinates,)."""
        inputs = self.model._checked(command)
        if len(inputs) != 1:
            raise ValueError(f"{len(inputs)} commands, where one is sent at a time")
        if self.memory is not None:
            sent = inputs[0]
            self.plays = self.model.robot.after(sent, self.plays)
            inputs = np.concatenate([sent, self.previous, self.plays.ravel(), [self.session]])[None]
            self.previous = sent
        positions, bounds = self.model._answer(inputs, self.place)
        return positions[0], bounds[0, :, 0], bounds[0, :, 1]


def encoded(value: Any) -> Any:
    """A node for JSON: arrays by their bytes, compressed."""
    if isinstance(value, dict):
        return {key: encoded(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [encoded(one) for one in value]
    if isinstance(value, np.ndarray):
        content = base64.b64encode(zlib.compress(np.ascontiguousarray(value).tobytes(), 6)).decode("ascii")
        return {"dtype": value.dtype.str, "shape": list(value.shape), "bytes": content}
    return value.item() if isinstance(value, np.generic) else value


def decoded(value: Any) -> Any:
    """The inverse of `encoded`."""
    if isinstance(value, list):
        return [decoded(one) for one in value]
    if not isinstance(value, dict):
        return value
    if set(value) == {"dtype", "shape", "bytes"}:
        content = zlib.decompress(base64.b64decode(value["bytes"]))
        return np.frombuffer(content, value["dtype"]).reshape(value["shape"])
    return {key: decoded(one) for key, one in value.items()}


def read(text: str) -> Model:
    """The model of the text of its numbers."""
    return Model(decoded(json.loads(text)))
