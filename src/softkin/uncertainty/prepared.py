"""Answers of a calibrated model, from what does not depend on the command: worked out once, in plain numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, lru_cache, partial
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.linalg.blas import dtrsv

from softkin.core.errors import ConfigError
from softkin.core.samples import Array
from softkin.models.plain.kernels import Node
from softkin.models.plain.parts import is_expanded, is_quick
from softkin.training.predict import spread_of
from softkin.uncertainty.beyond import Beyond
from softkin.uncertainty.calibration_data import SpreadCalibration
from softkin.uncertainty.intervals.spec import Scaled
from softkin.uncertainty.new_session import widened, zero_of_unseen
from softkin.uncertainty.plain.describe_robot import (
    estimator_numbers,
    growth_numbers,
    memory_numbers,
    place_numbers,
)
from softkin.uncertainty.plain.robot import PlainRobot
from softkin.uncertainty.promise import asked_levels

Levels = tuple[float, ...]
#: Tables of so many choices of levels are kept.
KEPT_LEVELS = 64
#: What is said of so many commands at most is kept.
KEPT_ROWS = 1_000


class Prepared:
    """The positions that the estimator of a calibrated `robot` predicts, and the bounds that its method and
    `in_domain_and_extrapolation` give, without fitting anything for each command.

    One row is answered from plain numbers, and so are many where that is quicker or more exact; else these are handed
    to the estimator: the same but for the order of sums.
    """

    def __init__(self, robot: Any) -> None:
        self.robot, self.known = robot, robot.known
        self.beyond = Beyond(robot.known, robot.shells, robot.norm)
        self.table = lru_cache(KEPT_LEVELS)(self._table_at)
        self._last: tuple[bytes, tuple[Array, Array | None]] | None = None
        self._last_place: tuple[bytes, tuple[NDArray[np.bool_], Array]] | None = None

    def predicted(self, inputs: Array) -> Array:
        """Positions (n_rows, n_coordinates) in mm at inputs that are checked."""
        if self.plain.members and (len(inputs) == 1 or self.is_plain):
            return self._placed(inputs)[0].copy()
        predicted = np.asarray(self.robot.estimator.predict(inputs))
        return predicted if self.robot.recalibration is None else predicted + self.robot.recalibration.zero

    def predicted_of_few(self, inputs: Array) -> Array:
        """As `predicted`; from plain numbers, where there are any, which is faster for a few rows."""
        return self.plain.placed(inputs)[0] if self.plain.members else self.predicted(inputs)

    def bounds(self, inputs: Array, levels: Levels, predicted: Array) -> Array:
        """Intervals (n_levels, n_rows, n_coordinates, 2) in mm at ascending levels, around positions `predicted`."""
        commands, table = inputs[:, : self.robot.train.commands.shape[1]], self.table(levels)
        if self.is_scaled:
            spread = self._spread(inputs) if self.plain.difficulty["kind"] == "spread" else None
            bounds = self.plain.in_domain(inputs, predicted, spread, table)
        else:
            bounds = self._by_method(inputs, levels, predicted)
        if not self.beyond.has_shells:
            return bounds
        outside, norms = self._place(commands)
        return self.plain.everywhere(bounds, predicted, outside, norms, table)

    def is_outside(self, commands: Array) -> NDArray[np.bool_]:
        """Which commands (n_rows, n_commands) lie in extrapolation, (n_rows,); as
        `in_domain_and_extrapolation.is_in_extrapolation`.
        """
        return self._place(commands)[0].copy()

    def make_ready(self, levels: Levels) -> None:
        """Work everything out now, for these levels, so that the first command takes no longer than the others."""
        inputs = self.robot.train.inputs[:1]
        self.bounds(inputs, levels, self.predicted(inputs))
        self.is_outside(self.known.train_commands[:1])

    @property
    def is_scaled(self) -> bool:
        """Whether in-domain bounds are known in plain numbers."""
        return self.robot.recalibration is not None or self.robot.method.scaled is not None

    @cached_property
    def is_plain(self) -> bool:
        """Whether many rows, too, are answered from plain numbers: polynomials, kernels that are expanded, and where
        spreads are made from the same kernel.
        """
        members = [member["regressor"] for member in self.numbers["members"]]
        has_spread = self.numbers["difficulty"]["kind"] == "spread"
        return has_spread or any(map(is_expanded, members)) or all(map(is_quick, members))

    @cached_property
    def plain(self) -> PlainRobot:
        """The robot in plain numbers."""
        return PlainRobot(self.numbers, _by_lapack)

    @cached_property
    def numbers(self) -> Node:
        """All but the tables of levels. Without `members`, its estimator cannot be written as plain numbers; without
        a `centre`, its command norm cannot.
        """
        robot, method = self.robot, self.robot.method
        is_new = robot.recalibration is not None or method.scaled is None
        difficulty: Node = {"kind": "none"} if is_new else dict(self._scaled.difficulty)
        try:
            has_spread = difficulty["kind"] == "spread"
            members = estimator_numbers(robot.estimator, robot.train, has_spread=has_spread)
        except ConfigError:
            members = {"members": [], "shares": np.zeros(0)}
        n_coordinates = self.known.truth.shape[1]
        return members | {
            "n_commands": robot.train.commands.shape[1],
            "memory": memory_numbers(robot.estimator),
            "zero": np.zeros(n_coordinates) if robot.recalibration is None else robot.recalibration.zero,
            "difficulty": difficulty,
            "surroundings": place_numbers(self.beyond),
            "growths": [growth_numbers(growth) for growth in self.beyond.growths] if self.beyond.has_shells else None,
            "has_spread": method.calibrated_on.has_spread,
        }

    @cached_property
    def _scaled(self) -> Scaled:
        return cast(Scaled, self.robot.method.scaled(self.known))

    def _table_at(self, levels: Levels) -> Node:
        """Numbers of these levels: `sides` (n_levels, n_coordinates, 2) of the in-domain bounds, what the `zero` of a
        session never seen adds, `limits` (n_levels, n_coordinates) of the errors on the calibration set, and those of
        each error-growth model, in units of what it predicts.
        """
        robot = self.robot
        table: Node = {"sides": None, "zero": None, "limits": None, "growth_limits": []}
        errors, asked = self.known.truth - self.known.calibration, asked_levels(robot.joint.promise, levels)
        if robot.recalibration is not None:
            half = robot.recalibration.half_widths(errors, asked)[:, 0]
            table["sides"] = np.stack([-half, half], axis=-1)
        elif robot.method.scaled is not None:
            table |= {"sides": self._scaled.sides(levels), "zero": zero_of_unseen(robot.estimator, levels)}
        if self.beyond.has_shells:
            table["limits"], table["growth_limits"] = self.beyond.limits(asked)
        return table

    def _by_method(self, inputs: Array, levels: Levels, predicted: Array) -> Array:
        """In-domain bounds of a method that is not known in plain numbers."""
        robot = self.robot
        data = replace(self.known, new=predicted, new_commands=inputs[:, : robot.train.commands.shape[1]])
        if isinstance(data, SpreadCalibration):
            data = replace(data, new_spread=self._spread(inputs))
        return widened(robot.method.intervals(data, levels), predicted, robot.estimator, inputs, levels)

    def _spread(self, inputs: Array) -> Array:
        """Spread (n_rows, n_coordinates) in mm of the estimator."""
        found = self._placed(inputs)[1] if self.plain.members else None
        if len(inputs) > 1:
            self._last = None  # many rows are kept no longer than between positions and bounds
        return spread_of(self.robot.spec, self.robot.estimator, self.robot.train, inputs) if found is None else found

    def _place(self, commands: Array) -> tuple[NDArray[np.bool_], Array]:
        """As `Beyond.place`; norms from plain numbers, where they are known. That of the last few commands is kept:
        bounds need it, and who asks for bounds mostly asks which commands lie outside.
        """
        key = commands.tobytes() if len(commands) <= KEPT_ROWS else b""
        if key and self._last_place is not None and self._last_place[0] == key:
            return self._last_place[1]
        is_plain = "centre" in self.plain.surroundings
        place = self.beyond.place(commands, self.plain.norms(commands) if is_plain else None)
        self._last_place = (key, place) if key else None
        return place

    def _placed(self, inputs: Array) -> tuple[Array, Array | None]:
        """Positions and spreads from plain numbers; those of the last inputs are kept, of many where they have a
        spread, which bounds then need.
        """
        if len(inputs) > 1 and self.plain.difficulty["kind"] != "spread":
            return self.plain.placed(inputs)
        key = inputs.tobytes()
        last = self._last
        if last is None or last[0] != key:
            self._last = last = key, self.plain.placed(inputs)
        return last[1]


def _by_lapack(lower: Array) -> Callable[[Array], Array]:
    """Solves for a lower triangle (n, n) as scikit-learn does, and faster for one column."""
    of_one = partial(dtrsv, lower, lower=1) if lower.flags.f_contiguous else partial(dtrsv, lower.T, lower=0, trans=1)

    def solved(right: Array) -> Array:
        if right.shape[1] == 1:
            return np.asarray(of_one(right[:, 0]))[:, None]
        return np.asarray(solve_triangular(lower, right, lower=True, check_finite=False))

    return solved
