"""Constant columns: a coordinate that never moves on train, a command that is never varied there."""

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
)
from softkin.data.audit.findings import WARNING, CheckResult, Finding


def check(samples: Mapping[str, Samples]) -> CheckResult:
    """A finding for constant coordinates, and one for constant commands."""
    train = samples[TRAIN]
    moving = informative_coordinates(train.positions)
    coordinates = [name for name, moves in zip(coordinate_columns(len(moving) // 3), moving, strict=True) if not moves]
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
                f"{len(coordinates)} of {len(moving)} coordinates never move on train (by less than "
                f"{CONSTANT_RANGE_MM:g} mm): {', '.join(coordinates)}{whole}.",
                "They are predicted without effort: averages over all coordinates look better than the robot is, and "
                "their R2 is 1 or 0 by floating-point luck. Read the columns named `_informative`.",
            )
        )
    if commands:
        findings.append(
            Finding(
                "constant_commands",
                WARNING,
                (TRAIN,),
                f"{len(commands)} of {len(varied)} commands never vary on train: {', '.join(commands)}.",
                "No model can learn what they do; predictions where they differ are guesses.",
            )
        )
    return CheckResult(tuple(findings), {"coordinates": coordinates, "commands": commands})
