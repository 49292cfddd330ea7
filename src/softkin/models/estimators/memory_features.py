"""What a model is given of a recorded row: its command alone, or with what the robot may remember of those before."""

from __future__ import annotations

from typing import Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin

from softkin.core.recording import MEMORIES as MEMORIES
from softkin.core.recording import NONE as NONE
from softkin.core.recording import PLAY as PLAY
from softkin.core.recording import PREVIOUS as PREVIOUS
from softkin.core.recording import WIDTHS, Array, input_parts, n_input_columns

#: Places in `WIDTHS` of the play operators of each set that a study may choose.
WIDTH_SETS = {"fine": (0, 2, 4), "coarse": (1, 3, 4), "all": tuple(range(len(WIDTHS)))}


class MemoryFeatures(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Inputs of recorded rows -> commands; with `memory` previous also the step from the previous command; with play
    also where in each play operator of the set `widths` the robot stands, command minus operator (the stop operator),
    which stays as small in extrapolation as it is in-domain.
    """

    def __init__(self, n_commands: int, memory: str = NONE, widths: str = "fine") -> None:
        self.n_commands = n_commands
        self.memory = memory
        self.widths = widths

    def fit(self, X: Array, y: Array | None = None) -> Self:  # noqa: ARG002 (scikit-learn's signature)
        """Nothing to learn."""
        return self

    def transform(self, X: Array) -> Array:
        """Inputs (n_rows, n_inputs) -> features (n_rows, n_features), in units of the commands."""
        commands, previous, plays, _ = input_parts(X, self.n_commands)
        parts = [commands]
        if self.memory != NONE:
            parts.append(commands - previous)
        if self.memory == PLAY:
            chosen = list(WIDTH_SETS[self.widths])
            parts.append((commands[:, None] - plays[:, chosen]).reshape(len(X), -1))
        return np.hstack(parts)


def n_features(n_commands: int, memory: str, widths: str = "fine") -> int:
    """How many features these settings give."""
    row = np.zeros((1, n_input_columns(n_commands)))
    return int(MemoryFeatures(n_commands, memory, widths).transform(row).shape[1])
