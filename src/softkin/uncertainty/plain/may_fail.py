"""Where poses may fail, by numpy alone. Exported Python files hold a copy of this text."""

from __future__ import annotations

from typing import Any

import numpy as np

from softkin.models.plain.evaluate import regressor
from softkin.models.plain.kernels import Node, Values


class MayFail:
    """What `FailureClass` answers, from its numbers: a `tree`; `lower` and `upper` (n_coordinates,) of failed poses;
    `least` (n_levels,), above which probability they may fail.
    """

    def __init__(self, node: Node) -> None:
        self.node, self.tree = node, regressor(node["tree"])

    def probability(self, commands: Values) -> Values:
        """Probability (n_rows,) that the pose at each command (n_rows, n_commands) fails."""
        with np.errstate(over="ignore"):  # the tree compares numbers of 32 bits
            return np.asarray(self.tree(commands)[0][:, 0])

    def at(self, commands: Values, place: int) -> Any:
        """Which commands (n_rows,) may fail, at the level of this place."""
        return self.probability(commands) > self.node["least"][place]

    def widened(self, bounds: Values, commands: Values, place: int) -> Values:
        """Bounds (n_rows, n_coordinates, 2) at the level of this place that hold failed poses, where they may fail."""
        lower = np.minimum(bounds[..., 0], self.node["lower"])
        upper = np.maximum(bounds[..., 1], self.node["upper"])
        return np.where(self.at(commands, place)[:, None, None], np.stack([lower, upper], axis=-1), bounds)
