"""Recordings: when rows were measured, and what a robot may remember of its commands.

A robot that remembers answers to the commands before, too. Everything here is computed from commands alone, in the
order in which they were sent: a controller knows what it has told the robot, and never where the robot was. A session
is one power-on of a robot: it begins at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

#: Half-widths of the play operators, in units of each command's range: from the play of a drive to the friction of
#: long tendons. Chosen before any fit, each twice the one before.
WIDTHS = (0.0125, 0.025, 0.05, 0.1, 0.2)
#: What a model may be told of the commands before, from nothing to most.
NONE, PREVIOUS, PLAY = MEMORIES = ("none", "previous", "play")


@dataclass(frozen=True, slots=True)
class CommandMemory:
    """What a robot of these commands may remember: `rest` (n_commands,) is the command at which a session begins,
    `ranges` (n_commands,) is the width of each command's range.
    """

    rest: Array
    ranges: Array

    @classmethod
    def of(cls, commands: Array) -> Self:
        """Rest and ranges of recorded `commands` (n_rows, n_commands): rest is the command nearest to zero in range."""
        low, high = commands.min(axis=0), commands.max(axis=0)
        return cls(np.clip(0.0, low, high), high - low)

    def start(self) -> Array:
        """The memory (n_memory,) of a robot at rest."""
        return np.tile(self.rest, 1 + len(WIDTHS))

    def half_widths(self) -> Array:
        """Half-widths (n_widths, n_commands) of the play operators, in units of the commands."""
        return np.outer(WIDTHS, self.ranges)

    def along(self, commands: Array, before: Array | None = None, last: Array | None = None) -> Array:
        """Memory (n_rows, n_memory) at each of `commands` (n_rows, n_commands), sent one after the other.

        Parameters:
            commands: in the order in which they are sent.
            before: the memory (n_memory,) at the command before the first; None at rest.
            last: that command (n_commands,); None at rest.
        """
        n_commands = len(self.rest)
        plays = (self.start() if before is None else before)[n_commands:].reshape(len(WIDTHS), n_commands)
        previous = np.vstack([self.rest if last is None else last, commands[:-1]])
        halves = self.half_widths()
        result = np.empty((len(commands), len(WIDTHS), n_commands))
        for row, command in enumerate(commands):
            plays = np.minimum(np.maximum(plays, command - halves), command + halves)
            result[row] = plays
        return np.hstack([previous, result.reshape(len(commands), -1)])

    def from_rest(self, commands: Array) -> Array:
        """Memory (n_rows, n_memory) at each of `commands` (n_rows, n_commands), each the first after rest."""
        return self.next_after(commands)

    def next_after(self, commands: Array, before: Array | None = None, last: Array | None = None) -> Array:
        """Memory (n_rows, n_memory) at each of `commands` (n_rows, n_commands), each the next one; as `along`."""
        n_commands, halves = len(self.rest), self.half_widths()[None]
        plays = (self.start() if before is None else before)[n_commands:].reshape(len(WIDTHS), n_commands)
        moved = np.minimum(np.maximum(plays, commands[:, None] - halves), commands[:, None] + halves)
        previous = self.rest if last is None else last
        return np.hstack([np.tile(previous, (len(commands), 1)), moved.reshape(len(commands), -1)])

    def recorded(self, commands: Array, order: Whole, session: Whole) -> Recording:
        """The recording of all `commands` (n_rows, n_commands) that were sent, in any order of rows."""
        memory = np.empty((len(commands), len(self.start())))
        in_time = np.argsort(order, kind="stable")
        for number in np.unique(session):
            rows = in_time[session[in_time] == number]
            memory[rows] = self.along(commands[rows])
        return Recording(order, session, memory, self)


@dataclass(frozen=True, slots=True)
class Recording:
    """When rows were measured: `order` (n_rows,), unique; `session` (n_rows,), numbered from 1 in the order of time;
    `memory` (n_rows, n_memory), what the robot may remember at each, in the columns of `memory_columns`; `robot` says
    how it is computed.
    """

    order: Whole
    session: Whole
    memory: Array
    robot: CommandMemory

    def take(self, rows: NDArray[Any] | slice) -> Self:
        """The recording of some rows."""
        return type(self)(self.order[rows], self.session[rows], self.memory[rows], self.robot)


def play(commands: Array, half_width: float, start: Array) -> Array:
    """The play operator (n_rows, n_commands) along a sequence of commands: backlash of a `half_width` to either side.

    It follows the command only when the command has crossed its play, from `start` (n_commands,). Source:
    Krasnosel'skii and Pokrovskii (1989), Systems with Hysteresis; sums of such operators are Prandtl-Ishlinskii models.
    """
    result = np.empty_like(commands)
    for row, command in enumerate(commands):
        start = np.minimum(np.maximum(start, command - half_width), command + half_width)
        result[row] = start
    return result


def memory_columns(n_commands: int) -> list[str]:
    """Names of the columns of memory: previous_u1, ..., play1_u1, ..., play2_u1, ..."""
    kinds = ["previous", *(f"play{place + 1}" for place in range(len(WIDTHS)))]
    return [f"{kind}_u{command + 1}" for kind in kinds for command in range(n_commands)]


def input_parts(inputs: Array, n_commands: int) -> tuple[Array, Array, Array, Array]:
    """Commands, previous commands, play operators (n_rows, n_widths, n_commands) and sessions (n_rows,) of `inputs`."""
    commands, previous = inputs[:, :n_commands], inputs[:, n_commands : 2 * n_commands]
    plays = inputs[:, 2 * n_commands : -1].reshape(len(inputs), len(WIDTHS), n_commands)
    return commands, previous, plays, inputs[:, -1]


def n_input_columns(n_commands: int) -> int:
    """Columns of the inputs of a recorded row: command, memory, session."""
    return n_commands * (2 + len(WIDTHS)) + 1


def gaps(order: Sequence[int] | Whole) -> int:
    """How many whole numbers are missing between the first and the last of a recording's `order`."""
    return int(np.max(order) - np.min(order) + 1 - len(order))
