"""Tables of a made-up robot, as somebody may export them."""

from __future__ import annotations

import pandas as pd

from tests.conftest import bending_arm

SIZE = 200


def columns(*names: str, scale: float = 1.0) -> pd.DataFrame:
    """A table of the names: of commands where they start with u, p or f, else of positions."""
    arm = bending_arm(SIZE, n_commands=3, n_markers=4)
    values = iter([*arm.positions.T[3:]])
    commands = iter([*arm.commands.T])
    return pd.DataFrame(
        {name: next(commands) if name[0] in "upf" else next(values) * scale for name in names}, index=range(SIZE)
    )
