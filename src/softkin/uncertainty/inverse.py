"""From a wish to a command: the commands that take a marker nearest to targets, and what the robot then promises."""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.errors import ConfigError, DataError
from softkin.core.rows import sampled_rows
from softkin.core.samples import Array, command_columns, informative_coordinates
from softkin.uncertainty import calls
from softkin.uncertainty.answers import index_of
from softkin.uncertainty.command_answers import NEAREST, OUTSIDE, REACHABLE, CommandAnswers
from softkin.uncertainty.command_search import CommandSearch
from softkin.uncertainty.conformal import conformal_limit, conformal_limits
from softkin.uncertainty.control_loop import State
from softkin.uncertainty.promise import asked_levels
from softkin.uncertainty.search_starts import SearchStarts
from softkin.uncertainty.targets import checked_step, checked_tolerance, marker_of, target_rows

#: Searches begin at so many commands of `train` at most, and are made for so many targets at a time.
MAX_ROWS_SEARCHED, TARGETS_AT_ONCE = 2_000, 500
#: Answers that are held against all errors of the calibration set at a time.
ROWS_AT_ONCE = 100
#: A search ends when the residual is at most this share of the marker's median error, or of how far it moves.
SHARE_OF_ERROR, SHARE_OF_EXTENT = 0.01, 1e-6


class Inverse:
    """What a calibrated model answers to targets."""

    def command_for(
        self: Any,
        targets: calls.Rows,
        marker: int = -1,
        confidence: float = 0.9,
        *,
        tolerance: float | None = None,
        last: State | calls.Rows | None = None,
        max_step: float | calls.Rows | None = None,
    ) -> CommandAnswers | pd.DataFrame:
        """Commands within the bounds of `train` whose predicted positions are nearest to targets, each by itself: a
        `CommandAnswers`, or a DataFrame for a DataFrame.

        Of commands that are equally good one in-domain is taken, then the nearest to `last`. Promises are those of
        commands exchangeable with the calibration set; these are picked by the model, for targets that anyone names.

        Parameters:
            targets: positions (n_rows, 3) of the marker in mm, or a DataFrame by the robot's own names and unit.
            marker: which one, from 0; -1 is the last.
            confidence: level of `intervals` and of `within_mm`.
            tolerance: mm; the probability is told that the marker is no farther from the target.
            last: the command sent before, or the State of a control loop, whose memory and session then count. None:
                the robot is at rest, in a session never seen.
            max_step: how much a command may differ from `last`: one number, or (n_commands,).

        Raises:
            DataError, ConfigError: no such targets, marker, level, tolerance, last command or step.
        """
        return _Wish(self, targets, marker, confidence, tolerance).answered(last, max_step, in_a_row=False)

    def command_path(
        self: Any,
        targets: calls.Rows,
        marker: int = -1,
        confidence: float = 0.9,
        *,
        tolerance: float | None = None,
        last: State | calls.Rows | None = None,
        max_step: float | calls.Rows | None = None,
    ) -> CommandAnswers | pd.DataFrame:
        """Commands that take a marker along targets, sent one after the other: as `command_for`, each searched from the
        one before, with what the robot then remembers. `max_step` is between neighbours, too; without `last` the first
        command is free. The State that is given stays where it is.
        """
        return _Wish(self, targets, marker, confidence, tolerance).answered(last, max_step, in_a_row=True)

    @cached_property
    def _starts(self: Any) -> tuple[Array, Array]:
        """Commands of `train` (n_rows, n_commands) that searches begin at, and the poses predicted there."""
        rows = sampled_rows(len(self.train), MAX_ROWS_SEARCHED, seed=0)
        commands = self.train.commands[rows]
        return commands, np.asarray(self.predict(commands))


class _Wish:
    """Targets of one marker of a robot, checked, and their answer."""

    def __init__(self, robot: Any, targets: calls.Rows, marker: int, confidence: float, tolerance: float | None):
        self.robot, self.asked, names = robot, targets, robot.names
        self.marker = marker_of(marker, names.n_coordinates // 3, robot.dataset)
        self.targets = target_rows(targets, names, self.marker, robot.dataset)
        self.level = calls.level_of(confidence, robot.dataset)
        self.tolerance = checked_tolerance(tolerance, robot.dataset)
        self.own = slice(3 * self.marker, 3 * self.marker + 3)
        self.errors = (robot.known.truth - robot.known.calibration)[:, self.own]
        self.lower, self.upper = robot.train.commands.min(axis=0), robot.train.commands.max(axis=0)
        poses = robot._starts[1][:, self.own]
        self.extent_mm = float(np.linalg.norm(np.ptp(poses, axis=0))) or 1.0
        typical = float(np.median(np.linalg.norm(self.errors, axis=1)))
        self.close_mm = max(SHARE_OF_ERROR * typical, SHARE_OF_EXTENT * self.extent_mm)

    def answered(self, last: Any, max_step: Any, *, in_a_row: bool) -> CommandAnswers | pd.DataFrame:
        """The commands, `in_a_row` sent one after the other, each else from `last`."""
        state = self._state(last)
        step = checked_step(max_step, len(self.lower), self.robot.dataset)
        if step is not None and state.last is None and not in_a_row:
            raise ConfigError(
                "max_step without a last command", where=self.robot.dataset, fix="pass the command sent before as last"
            )
        if in_a_row:
            commands, inputs = self._along(state, step)
        else:
            places = range(0, len(self.targets), TARGETS_AT_ONCE)
            parts = [self.targets[start : start + TARGETS_AT_ONCE] for start in places]
            commands = np.vstack([self._searched(part, state, step, in_a_row=False) for part in parts])
            inputs = state.next_inputs(commands)
        answers = self._promised(commands, inputs)
        if not isinstance(self.asked, (pd.DataFrame, pd.Series)):
            return answers
        names = list(self.robot.names.own_commands) or command_columns(len(self.lower))
        return answers.table(names, self.marker, index_of(self.asked))

    def _along(self, state: State, step: Array | None) -> tuple[Array, Array]:
        """Commands sent one after the other, and what the model is given at each."""
        commands, inputs = [], []
        for target in self.targets:
            commands.append(self._searched(target[None], state, step, in_a_row=True)[0])
            inputs.append(state.inputs(commands[-1])[0])
        return np.array(commands), np.array(inputs)

    def _state(self, last: Any) -> State:
        """Where the robot is when the first command is sent; one that was given is not moved."""
        if isinstance(last, State):
            if last.robot.train is not self.robot.train:
                raise DataError("a state of another robot", where=self.robot.dataset, fix="pass what its start() gave")
            return copy(last)
        state = State(self.robot)
        if last is not None:
            state.input_of(last)
        return state

    def _search(self, state: State, step: Array | None) -> CommandSearch:
        """The search among the commands that may be sent next."""
        lower, upper = self.lower, self.upper
        if step is not None and state.last is not None:
            lower, upper = np.maximum(lower, state.last - step), np.minimum(upper, state.last + step)
            if (lower > upper).any():
                raise DataError(
                    "no command between the bounds of train is within max_step of the last",
                    where=self.robot.dataset,
                    fix="allow a larger step, or pass a last command that is nearer to those of train",
                )

        def position(commands: Array) -> Array:
            return np.asarray(self.robot._prepared.predicted_of_few(state.next_inputs(commands)))[:, self.own]

        return CommandSearch(position, self.robot.is_outside, lower, upper, self.extent_mm, self.close_mm)

    def _searched(self, targets: Array, state: State, step: Array | None, *, in_a_row: bool) -> Array:
        """Commands (n_targets, n_commands), each sent after the last one."""
        search, last = self._search(state, step), state.last
        commands, poses = self.robot._starts
        width = np.where(self.upper > self.lower, self.upper - self.lower, 1.0)
        between = None if last is None else np.clip(last, search.lower, search.upper)
        starts = SearchStarts(
            targets, poses[:, self.own], np.clip(commands, search.lower, search.upper), width, between,
            in_a_row=in_a_row,
        )  # fmt: skip
        return search.nearest_each(targets, starts, last, first_wins=in_a_row or last is None)

    def _promised(self, commands: Array, inputs: Array) -> CommandAnswers:
        """The answers: what the errors of the marker on the calibration set promise around each predicted position."""
        whole = np.asarray(self.robot._prepared.predicted_of_few(inputs))
        intervals = np.asarray(self.robot.intervals(inputs, self.level, whole))[:, self.own]
        positions = whole[:, self.own]
        off = positions - self.targets
        residual = np.linalg.norm(off, axis=1)
        within, radius, near = (np.empty(len(off)) for _ in range(3))
        promise = self.robot.joint.promise
        by_block = promise is not None and promise.n_blocks > 1
        (level,) = asked_levels(promise, [self.level])
        n_places = (promise.n_blocks + 1) * promise.n_rows if by_block else len(self.errors) + 1
        regularly = stretches = self._stretch(intervals, positions, level)
        if self.robot.failures is not None:  # where a pose may fail its intervals hold failed poses, too
            regular = self.robot._prepared.bounds(inputs, (self.level,), whole)[0][:, self.own]
            regularly = self._stretch(regular, positions, level)
        is_alike = bool((regularly == regularly[:1]).all())
        for start in range(0, len(off), ROWS_AT_ONCE):
            rows = slice(start, start + ROWS_AT_ONCE)
            distances = _distances(off[rows], stretches[rows], self.errors)
            within[rows] = conformal_limits(distances.T, [level])[0]
            # Failed poses bring no target nearer.
            own = regularly[:1] if is_alike else regularly[rows]
            by_error = _distances(np.zeros_like(own), own, self.errors)
            radius[rows] = conformal_limits(by_error.T, [level])[0]
            near[rows] = 0.0 if self.tolerance is None else (distances <= self.tolerance).sum(axis=1)
        radius = np.where(np.isfinite(radius), radius, 0.0)
        verdict = np.where(residual <= np.maximum(radius, self.close_mm), REACHABLE, NEAREST)
        verdict[np.asarray(self.robot.is_outside(commands))] = OUTSIDE
        return CommandAnswers(
            commands, positions, intervals, residual, within,
            None if self.tolerance is None else near / n_places, verdict,
        )  # fmt: skip

    def _stretch(self, intervals: Array, positions: Array, level: float) -> Array:
        """How many times (n_rows, 3) errors are those of the calibration set: as intervals are wider, at least once."""
        half = np.abs(intervals - positions[..., None]).max(axis=-1)
        known = np.array([conformal_limit(np.abs(column), level) for column in self.errors.T])
        moving = informative_coordinates(self.robot.train.positions)[self.own]
        told = moving & np.isfinite(known) & (known > 0)
        return np.where(told, np.maximum(1.0, half / np.where(told, known, 1.0)), 1.0)


def _distances(off: Array, stretches: Array, errors: Array) -> Array:
    """Lengths (n_rows, n_errors) of `off` (n_rows, 3) and each of `errors` (n_errors, 3) together, times `stretches`
    (n_rows, 3); infinite where one of these is.
    """
    told = np.isfinite(stretches)
    finite = np.where(told, stretches, 0.0)
    squares = np.square(off).sum(axis=1)[:, None] + 2 * (off * finite) @ errors.T + finite**2 @ (errors**2).T
    return np.where(told.all(axis=1, keepdims=True), np.sqrt(np.maximum(squares, 0.0)), np.inf)
