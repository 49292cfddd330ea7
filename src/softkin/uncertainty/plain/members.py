"""Positions of an ensemble's members in plain numbers, by numpy alone. Exported Python files hold a copy of this text.

What members share is worked out once for a row: what they are told of earlier commands, and their target space.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from softkin.models.plain.evaluate import Regressor, regressor
from softkin.models.plain.kernels import Node, Solver, Values
from softkin.models.plain.spaces import space


class Members:
    """Positions from `members`, a regressor and a target space each, weighted by `shares`."""

    def __init__(self, numbers: Node, solver: Solver | None = None) -> None:
        self.shares, self.n_commands = numbers["shares"], numbers["n_commands"]
        self.regressors: list[Regressor] = []
        self.given: list[int] = []
        self.scaled: list[tuple[list[int] | None, Node]] = []
        for member in numbers["members"]:
            node, told = member["regressor"], _places(self.n_commands, member["has_step"], member["widths"])
            scaler = {name: node[name] for name in ("mean", "scale")} if node["kind"] == "standardised" else {}
            key = next((i for i, one in enumerate(self.scaled) if one[0] == told and _is_same(one[1], scaler)), None)
            if key is None:
                self.scaled.append((told, scaler))
            self.given.append(len(self.scaled) - 1 if key is None else key)
            self.regressors.append(regressor(node["inner"] if scaler else node, solver))
        nodes: list[Node] = []
        groups: list[list[int]] = []
        for place, member in enumerate(numbers["members"]):
            same = next((group for group, node in enumerate(nodes) if _is_same(node, member["space"])), None)
            if same is None:
                nodes.append(member["space"])
                groups.append([place])
            else:
                groups[same].append(place)
        self.spaces = [(space(node), group) for node, group in zip(nodes, groups, strict=True)]

    def placed(self, inputs: Values) -> tuple[Values, Values | None]:
        """Positions (n_rows, n_coordinates) in mm, without zeros of sessions, at inputs: commands alone, or with what
        the robot remembers and the session; and the spread in mm of one member that has one.
        """
        features = self._features(inputs)
        answers = [one(features[place]) for one, place in zip(self.regressors, self.given, strict=True)]
        if len(answers) == 1:
            (targets, spread), (of_one, _) = answers[0], self.spaces[0]
            return of_one.positions(targets), None if spread is None else of_one.spread(targets, spread)
        parts: list[Any] = [None] * len(answers)
        for of_one, group in self.spaces:
            found = of_one.positions(np.concatenate([answers[place][0] for place in group]))
            for place, start in zip(group, range(0, len(found), len(inputs)), strict=True):
                parts[place] = found[start : start + len(inputs)].ravel()
        return np.dot(self.shares, np.stack(parts)).reshape(len(inputs), -1), None

    def __len__(self) -> int:
        return len(self.regressors)

    def _features(self, inputs: Values) -> list[Values]:
        """What members are given of inputs, each kind once: columns that they are told, by their scaler."""
        n = self.n_commands
        commands, whole = inputs[:, :n], inputs
        if inputs.shape[1] > n:
            moved = commands[:, None] - inputs[:, n:-1].reshape(len(inputs), -1, n)
            whole = np.concatenate([commands, moved.reshape(len(inputs), -1)], axis=1)
        given = []
        for told, scaler in self.scaled:
            some = commands if told is None else whole if len(told) == whole.shape[1] else whole.take(told, axis=1)
            given.append((some - scaler["mean"]) / scaler["scale"] if scaler else some)
        return given


def _places(n_commands: int, has_step: bool, widths: Values) -> list[int] | None:
    """Columns that a member is told: commands, the step from the previous command, and how far each of some play
    operators is behind; None: commands alone.
    """
    blocks = [0, *([1] if has_step else []), *(2 + int(width) for width in widths)]
    return [n_commands * block + place for block in blocks for place in range(n_commands)] if blocks[1:] else None


def _is_same(one: Any, other: Any) -> bool:
    """Whether two nodes hold the same numbers."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_is_same(value, other[key]) for key, value in one.items())
    return bool(np.array_equal(one, other))
