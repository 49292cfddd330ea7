"""What is answered to targets: commands, where they take a marker, and what is promised there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.samples import Array

REACHABLE, NEAREST, OUTSIDE = "reachable", "nearest", "outside"


@dataclass(frozen=True, eq=False)
class CommandAnswers:
    """A command for each target, and where it takes the marker.

    `commands` (n_rows, n_commands). Of the marker, in mm: `positions` (n_rows, 3) that the model predicts, `intervals`
    (n_rows, 3, 2) at the confidence level, `residual_mm` (n_rows,) from the predicted position to the target;
    `within_mm` (n_rows,), no farther than which the robot is from the target with that confidence. `probability`
    (n_rows,): that it is within the `tolerance` that was given; None where none was. `verdict` (n_rows,): `outside`,
    the command lies in extrapolation, where nothing is promised; else `reachable`, the target is no farther from the
    predicted position than the robot is with that confidence; else `nearest`, no command was found that gets there.
    """

    commands: Array
    positions: Array
    intervals: Array
    residual_mm: Array
    within_mm: Array
    probability: Array | None
    verdict: NDArray[np.str_]

    def table(self, command_names: list[str], marker: int, index: pd.Index) -> pd.DataFrame:
        """The same as a table with columns u1, ..., m1_x, lower_m1_x, upper_m1_x, ..., residual_mm, verdict."""
        columns: dict[str, Any] = dict(zip(command_names, self.commands.T, strict=True))
        for axis, name in enumerate("xyz"):
            columns[f"m{marker + 1}_{name}"] = self.positions[:, axis]
            columns[f"lower_m{marker + 1}_{name}"] = self.intervals[:, axis, 0]
            columns[f"upper_m{marker + 1}_{name}"] = self.intervals[:, axis, 1]
        columns |= {"residual_mm": self.residual_mm, "within_mm": self.within_mm}
        columns |= {} if self.probability is None else {"probability": self.probability}
        return pd.DataFrame(columns | {"verdict": self.verdict}, index=index)
