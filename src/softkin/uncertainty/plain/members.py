"""Positions of an ensemble's members in plain numbers, by numpy alone. Exported Python files hold a copy of this text.

What members share is worked out once for a row: what they are told of earlier commands, and their target space.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from softkin.models.plain.evaluate import regressor
from softkin.models.plain.kernels import Node, Solver, Values
from softkin.models.plain.spaces import space


class Members:
    """Positions from `members`, a regressor and a target space each, weighted by `shares`."""

    def __init__(self, numbers: Node, solver: Solver | None = None) -> None:
        self.shares, self.n_commands = numbers["shares"], numbers["n_commands"]
        self.regressors = [regressor(member["regressor"], solver) for member in numbers["members"]]
        self.told = [(member["has_step"], tuple(member["widths"])) for member in numbers["members"]]
        self.moved = {told: _places(*told) for told in self.told}
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
        told = self._features(inputs)
        answers = [one(told[key]) for one, key in zip(self.regressors, self.told, strict=True)]
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

    def _features(self, inputs: Values) -> dict[tuple[bool, tuple[int, ...]], Values]:
        """What members are given of inputs, by what they are told."""
        n = self.n_commands
        commands = inputs[:, :n]
        if inputs.shape[1] == n:
            return dict.fromkeys(self.moved, commands)
        moved = commands[:, None] - inputs[:, n:-1].reshape(len(inputs), -1, n)
        return {
            told: np.hstack([commands, moved[:, places].reshape(len(inputs), -1)]) if places else commands
            for told, places in self.moved.items()
        }


def _places(has_step: bool, widths: tuple[int, ...]) -> list[int]:
    """Of the step from the previous command, 0, and of play operators, whose widths begin at 1."""
    return [*([0] if has_step else []), *(1 + int(width) for width in widths)]


def _is_same(one: Any, other: Any) -> bool:
    """Whether two nodes hold the same numbers."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_is_same(value, other[key]) for key, value in one.items())
    return bool(np.array_equal(one, other))
