"""Calibrated models in plain numbers, evaluated by numpy alone. Exported Python files hold a copy of this text."""

from __future__ import annotations

from typing import Any

import numpy as np

from softkin.models.plain.kernels import Node, Solver, Values
from softkin.uncertainty.plain.members import Members
from softkin.uncertainty.plain.near_errors import near_errors, of_one_command

Mask = np.ndarray[Any, np.dtype[np.bool_]]
#: Distances between commands that are held at a time.
DISTANCES_AT_ONCE = 4_000_000
#: So many numbers in a row numpy no longer adds one after the other.
SUMMED_IN_TURN = 8


class PlainRobot:
    """Positions, spreads, what lies outside and bounds, from the numbers of `robot_numbers`.

    Inputs are commands (n_rows, n_commands), or with what the robot remembers and the session beside them.
    """

    def __init__(self, numbers: Node, solver: Solver | None = None) -> None:
        self.numbers, self.memory, self.growths = numbers, numbers["memory"], numbers["growths"]
        self.members = Members(numbers, solver)
        self.surroundings, self.difficulty = numbers["surroundings"], numbers["difficulty"]
        self.points = self.surroundings["points"].T.copy()
        if self.growths:
            names = ("floor", "slope", "bend", "steepest", "reach")
            parts = ([np.atleast_1d(growth[name]) for growth in self.growths] for name in names)
            self.grown = [np.stack(part)[..., None] for part in parts]
        if self.difficulty["kind"] == "distance":
            self.neighbours = self.difficulty["points"].T.copy()
        if self.difficulty["kind"] == "held_out":
            self.near_errors = of_one_command(self.difficulty)

    def placed(self, inputs: Values) -> tuple[Values, Values | None]:
        """Positions (n_rows, n_coordinates) in mm, and spreads in mm where the bounds need them: then there is one
        member.
        """
        positions, spread = self.members.placed(self._whole(inputs))
        if self.memory is not None:
            positions = positions + self._zeros(inputs)
        return positions + self.numbers["zero"], spread

    def outside(self, commands: Values, norms: Values) -> Mask:
        """Which commands (n_rows, n_commands) lie in extrapolation, (n_rows,)."""
        places = self.surroundings
        step = max(1, DISTANCES_AT_ONCE // self.points.size)
        far = [
            np.sqrt(_squared_distances(self.points, (part - places["mean"]) / places["scale"]).min(axis=1))
            > places["gap"]
            for part in (commands[start : start + step] for start in range(0, len(commands), step))
        ]
        return np.asarray(np.concatenate(far) | (norms > places["radius"]))

    def norms(self, commands: Values) -> Values:
        """Command norms (n_rows,)."""
        places = self.surroundings
        varying = commands if len(places["varies"]) == commands.shape[1] else commands[:, places["varies"]]
        parts = (varying - places["centre"]) / places["norm_scale"]
        parts *= parts
        if not 0 < parts.shape[1] < SUMMED_IN_TURN:
            return np.asarray(np.sqrt(parts.sum(axis=1)))
        squares = parts[:, 0].copy()  # the same sums, which along rows of few numbers are slow
        for place in range(1, parts.shape[1]):
            squares += parts[:, place]
        return np.asarray(np.sqrt(squares))

    def in_domain(self, inputs: Values, predicted: Values, spread: Values | None, table: Node) -> Values:
        """Bounds (n_levels, n_rows, n_coordinates, 2) in mm around positions `predicted`, as of commands in-domain; a
        `table` has the numbers of some levels.
        """
        sides, difficulty = table["sides"][:, None], self._difficulties(inputs, spread)
        if difficulty is not None:
            sides = sides * difficulty[..., None]
        if table["zero"] is not None:
            unseen = (self._sessions(inputs)[:, None] != self.memory["sessions"]).all(axis=1)
            zero = table["zero"][:, None] * unseen[:, None]
            sides = np.sign(sides) * np.hypot(sides, zero[..., None])
        bounds = np.empty((len(sides), *predicted.shape, 2))
        for side in (0, 1):  # along the last axis, of two numbers, arrays are added slowly
            np.add(predicted, sides[..., side], out=bounds[..., side])
        return bounds

    def everywhere(self, bounds: Values, predicted: Values, outside: Mask, norms: Values, table: Node) -> Values:
        """In-domain `bounds`, in which those of commands that lie outside are other ones, where there are shells."""
        if self.growths is None or not outside.any():
            return bounds
        rows = slice(None) if outside.all() else outside
        middle, widest = predicted[rows], self._widest(norms[rows], table)
        lower, upper = middle - widest, middle + widest
        if self.numbers["has_spread"]:
            lower = np.minimum(bounds[..., 0][:, rows], lower)
            upper = np.maximum(bounds[..., 1][:, rows], upper)
        bounds[..., 0][:, rows], bounds[..., 1][:, rows] = lower, upper
        return bounds

    def from_rest(self, commands: Values) -> Values:
        """Inputs (n_rows, n_inputs) of commands that are each sent to a robot at rest, in a session never seen."""
        if self.memory is None:
            return commands
        rest, halves = self.memory["rest"], self.memory["halves"][None]
        plays = np.minimum(np.maximum(rest, commands[:, None] - halves), commands[:, None] + halves)
        parts = [commands, np.tile(rest, (len(commands), 1)), plays.reshape(len(commands), -1)]
        return np.hstack([*parts, np.zeros((len(commands), 1))])

    def after(self, command: Values, plays: Values) -> Values:
        """Where the play operators (n_widths, n_commands) stand after a command (n_commands,)."""
        halves = self.memory["halves"]
        return np.asarray(np.minimum(np.maximum(plays, command - halves), command + halves))

    def _whole(self, inputs: Values) -> Values:
        if self.memory is None:
            return inputs
        return self.from_rest(inputs) if inputs.shape[1] == self.numbers["n_commands"] else inputs

    def _sessions(self, inputs: Values) -> Values:
        return self._whole(inputs)[:, -1]

    def _zeros(self, inputs: Values) -> Values:
        """Zeros (n_rows, n_coordinates) in mm of the sessions; 0 of one never seen."""
        is_known = self._sessions(inputs)[:, None] == self.memory["sessions"]
        return np.asarray(is_known.astype(np.float64) @ self.memory["zeros"])

    def _difficulties(self, inputs: Values, spread: Values | None) -> Values | None:
        """What the sides of each row are multiplied by, (n_rows, n_coordinates) or (n_rows, 1); None: by 1."""
        node = self.difficulty
        if node["kind"] == "spread":
            return np.asarray(np.maximum(spread + node["least"], node["floor"]))
        if node["kind"] == "distance":
            return self._distances(inputs[:, : self.numbers["n_commands"]])
        if node["kind"] == "held_out":
            commands = inputs[:, : self.numbers["n_commands"]]
            found = self.near_errors(commands) if len(commands) == 1 else near_errors(node, commands)
            return np.asarray(np.maximum(found, node["floor"]))
        return None

    def _distances(self, commands: Values) -> Values:
        """Mean distance to the nearest commands of `train`; beyond its box the distance to the box is added."""
        node, step = self.difficulty, max(1, DISTANCES_AT_ONCE // self.neighbours.size)
        found = []
        for start in range(0, len(commands), step):
            rows = (commands[start : start + step] - node["mean"]) / node["scale"]
            squares = np.partition(_squared_distances(self.neighbours, rows), node["neighbours"] - 1, axis=1)
            near = np.sqrt(squares[:, : node["neighbours"]]).mean(axis=1)
            apart = rows - np.clip(rows, node["low"], node["high"])
            beyond = np.sqrt((apart * apart).sum(axis=1))
            near = np.where(beyond > 0, node["emptiest"] + beyond, np.minimum(near, node["emptiest"]))
            found.append(np.maximum(node["least"] + near / node["unit"], node["floor"]))
        return np.concatenate(found)[:, None]

    def _widest(self, norms: Values, table: Node) -> Values:
        """Half-widths (n_levels, n_rows, n_coordinates) in mm in extrapolation."""
        widest = np.broadcast_to(table["limits"][..., None], (*table["limits"].shape, len(norms)))
        if self.growths:
            floor, slope, bend, steepest, reach = self.grown
            x = np.log(np.maximum(norms / self.surroundings["radius"], 1.0))
            near = np.minimum(x, reach)
            grown = np.exp(floor + (near * slope + near**2 * bend + (x - near) * steepest))
            limits = np.stack(table["growth_limits"])[..., None]
            widest = np.maximum(widest, (limits * grown[:, None]).max(axis=0))
        return np.asarray(widest.transpose(0, 2, 1))


def _squared_distances(points: Values, rows: Values) -> Values:
    """Squared distances (n_rows, n_points) of rows (n_rows, n_commands) to points (n_commands, n_points)."""
    apart = points - rows[:, :, None]
    apart *= apart
    return np.asarray(apart.sum(axis=1))
