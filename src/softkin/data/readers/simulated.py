"""Reader of a stand-in: its file is a recipe (JSON: robot, seed, rows), which is simulated when it is read."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from softkin.core.files import read_json
from softkin.core.samples import Samples

#: Keys of a recipe: all that decides a simulated pose.
RECIPE = ("robot", "seed", "rows")


def read(path: str | Path, *, dataset: str, source: Mapping[str, Any]) -> dict[str, Samples]:  # noqa: ARG001
    """Samples per subset, positions in mm.

    Raises:
        SoftkinError: an unknown robot, or a pose that cannot be solved.
    """
    from softkin.data.standins.simulating import simulate

    recipe = read_json(path)
    return simulate(recipe["robot"], n_rows=recipe["rows"], seed=recipe["seed"])
