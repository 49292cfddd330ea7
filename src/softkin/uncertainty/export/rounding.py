"""How well a calibrated model itself is known: one command against the same command among many."""

from __future__ import annotations

from typing import Any

import numpy as np

#: Commands of `train` that are compared.
COMPARED = 100
#: mm; less is not worth a word.
PARITY = 1e-9
LEVEL = 0.9


def rounding(robot: Any) -> float:
    """The largest difference in mm of positions and bounds between the model's answers to one command and to many."""
    rows = robot.train.inputs[:: max(1, len(robot.train) // COMPARED)]
    many = np.asarray(robot.intervals(rows, LEVEL))
    one = np.concatenate([np.asarray(robot.intervals(row[None], LEVEL)) for row in rows])
    same = np.isinf(many) & (many == one)
    return float(np.abs(np.where(same, 0.0, many) - np.where(same, 0.0, one)).max())


def known_to(robot: Any) -> str:
    """A sentence on it; empty where they are the same to `PARITY`."""
    apart, unit = rounding(robot), robot.names.unit
    if apart <= PARITY:
        return ""
    return (
        f"Known to {apart:.0e} {unit}: so far apart, by rounding, are the model's answers to one command and to many "
        "at once; exports answer as for one, but for the rounding of a spread."
    )
