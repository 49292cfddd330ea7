"""What a calibrated model answers to the question of which way the tip points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pandas as pd

from softkin.core.errors import ConfigError
from softkin.core.rotations import KINDS, MATRIX, WXYZ, XYZW, to_numbers
from softkin.core.samples import Array
from softkin.uncertainty import calls
from softkin.uncertainty.answers import like
from softkin.uncertainty.orientation_model import ORIENTATION

#: Columns of an answer in a DataFrame, by kind; angles have the same of either unit.
COLUMNS = {XYZW: ["qx", "qy", "qz", "qw"], WXYZ: ["qw", "qx", "qy", "qz"]}
COLUMNS |= {MATRIX: [f"r{row}{column}" for row in "123" for column in "123"]}
ANGLES = ["roll", "pitch", "yaw"]


@dataclass(frozen=True, slots=True)
class Orientation:
    """Predicted `rotations` (n_rows, n_numbers), and the angle `bound_deg` in degrees, 0 to infinite, within which the
    measured one is at the level that was asked for; `guarantee` is what that promises in-domain. The bound is the same
    at all commands: in extrapolation it is no wider and promises nothing.
    """

    rotations: Array | pd.DataFrame
    bound_deg: float
    guarantee: str


class Orientations:
    """What a calibrated model knows of the orientation of the tip, where its dataset's entry names it."""

    def orientation(
        self: Any, commands: calls.Rows, confidence_level: float = 0.9, kind: str = XYZW
    ) -> Orientation | None:
        """Which way the tip points at commands, and how far off that may be; None where the entry names no orientation.

        A robot that remembers is taken to be sent each command from rest, as by `predict`. `recalibrate`, `p_values`,
        `watch` and `command_for` know positions alone: none of them touches orientations or looks at them.

        Parameters:
            commands: (n_rows, n_commands), as those of `predict`.
            confidence_level: of the bound.
            kind: in what the rotations are given, as in config/README.md: quaternion_xyzw by default.

        Raises:
            ConfigError: no such kind or level.
            DataError: no such commands.
        """
        model = self.about.get(ORIENTATION)
        inputs, level = self._checked(commands), calls.level_of(confidence_level, self.dataset)
        if kind not in KINDS:
            raise ConfigError(f"{kind!r} is no kind", where=self.dataset, fix=f"pass one of {', '.join(KINDS)}")
        if model is None:
            return None
        rotations = like(commands, to_numbers(model.vectors(inputs), kind), COLUMNS.get(kind, ANGLES))
        return Orientation(rotations, model.bound(level), model.guarantee(level))
