"""A made-up robot of two commands whose tip turns: smoothly, with noise, about a mean that is no identity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.rotations import about, from_mean, mean_of
from softkin.core.samples import SUBSETS, Array, Samples
from softkin.data.table import to_table, write_table
from tests.conftest import bending_arm

NOISE_DEGREES = 0.5
FRAME = np.array([0.3, -1.2, 0.8])


def oriented_arm(n_rows: int, seed: int = 0) -> Samples:
    """Rows with their orientation about none."""
    rows, rng = bending_arm(n_rows, seed=seed), np.random.default_rng(seed + 1000)
    first, second = rows.commands.T
    turned = np.column_stack([-second, first, 0.2 * first * second])
    turned += np.radians(NOISE_DEGREES) * rng.standard_normal((n_rows, 3))
    return replace(rows, orientation=from_mean(turned, FRAME))


def about_one_mean(subsets: Mapping[str, Samples]) -> tuple[dict[str, Samples], Array]:
    """The same rows about the mean of `train`, and that."""
    mean = mean_of(np.asarray(subsets["train"].orientation))
    return {
        name: replace(rows, orientation=about(np.asarray(rows.orientation), mean)) for name, rows in subsets.items()
    }, mean


def oriented_table(path: Path) -> dict[str, Any]:
    """Write a tidy table of such a robot; return what a description says of its orientation."""
    sizes = dict(zip(SUBSETS, (80, 40, 30, 20), strict=True))
    subsets, mean = about_one_mean({name: oriented_arm(size, seed) for seed, (name, size) in enumerate(sizes.items())})
    write_table(to_table(subsets), path)
    return {"orientation": {"mean_vector": mean.tolist()}}
