"""Check for constant columns: coordinates that never move on `train`, commands that never vary there."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from softkin.core.samples import (
    CONSTANT_RANGE_MM,
    TRAIN,
    Samples,
    command_columns,
    coordinate_columns,
    informative_coordinates,
    measured_coordinates,
)
from softkin.data.audit.findings import WARNING, CheckResult, Finding


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """At most one finding on constant coordinates, and one on constant commands."""
    train = samples[TRAIN]
    moving, measured = informative_coordinates(train.positions), measured_coordinates(train.positions)
    names = np.array(coordinate_columns(len(moving) // 3))
    coordinates = names[measured & ~moving].tolist()
    varied = np.ptp(train.commands, axis=0) > 0
    commands = [name for name, varies in zip(command_columns(len(varied)), varied, strict=True) if not varies]
    findings = []
    if coordinates:
        still = [f"marker {i + 1}" for i in range(len(moving) // 3) if not moving[3 * i : 3 * i + 3].any()]
        whole = f" ({', '.join(still)} as a whole)" if still else ""
        findings.append(
            Finding(
                "constant_coordinates",
                WARNING,
                (TRAIN,),
                f"{len(coordinates)} of {int(measured.sum())} coordinates never move on train (by less than "
                f"{CONSTANT_RANGE_MM:g} mm): {', '.join(coordinates)}{whole}.",
                "Any model predicts them exactly, so averages over all coordinates look better than the model is, and "
                "their R2 is 1 or 0, as rounding decides. Read the columns named `_informative`, which leave them out.",
            )
        )
    if commands:
        findings.append(
            Finding(
                "constant_commands",
                WARNING,
                (TRAIN,),
                f"{len(commands)} of {len(varied)} commands never vary on train: {', '.join(commands)}.",
                "No model can learn what they do: where they differ from train, predictions are guesses.",
            )
        )
    return CheckResult(tuple(findings), {"coordinates": coordinates, "commands": commands})
