"""Simulate a stand-in: its name -> samples per subset in mm, split as the published data are."""

from __future__ import annotations

import logging
from collections.abc import Mapping

import numpy as np

from softkin.core.errors import ConfigError
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, VALIDATION, Array, Samples
from softkin.data.standins import STANDINS

logger = logging.getLogger("softkin")


def simulate(name: str, *, n_rows: Mapping[str, int] | int, seed: int) -> dict[str, Samples]:
    """Samples per subset of the stand-in `name`, positions in mm; the same to the last bit for the same `seed`.

    Commands are distinct. The rows with the largest command norm are `extrapolation`, the others are drawn at random.
    `n_rows` gives the rows of each subset, or their total, of which 30 % are extrapolation and the rest 80/10/10.

    Raises:
        ConfigError: an unknown stand-in, sizes that cannot be split, or a pose that cannot be solved.
    """
    if name not in STANDINS:
        raise ConfigError("unknown", where=f"stand-in '{name}'", fix=f"name one of {', '.join(STANDINS)}")
    robot = STANDINS[name]
    sizes = subset_sizes(n_rows) if isinstance(n_rows, int) else dict(n_rows)
    if set(sizes) != set(SUBSETS) or min(sizes.values()) < 1:
        raise ConfigError(
            "every subset needs a row",
            where=f"stand-in '{name}', rows {sizes}",
            fix=f"give {', '.join(SUBSETS)} one row or more each, or a total of 8 or more",
        )
    drawing, measuring, splitting = np.random.default_rng(seed).spawn(3)
    commands = robot.draw(sum(sizes.values()), drawing)
    logger.info("simulating %s: %d rows, seed %d", robot.title, len(commands), seed)
    positions = robot.poses(commands, measuring)
    return {
        subset: Samples(commands[rows], positions[rows]) for subset, rows in split(commands, sizes, splitting).items()
    }


def subset_sizes(total: int) -> dict[str, int]:
    """Rows per subset: 30 % extrapolation, the rest 80/10/10."""
    outer = round(0.3 * total)
    held_out = round(0.1 * (total - outer))
    return {TRAIN: total - outer - 2 * held_out, VALIDATION: held_out, TEST: held_out, EXTRAPOLATION: outer}


def split(commands: Array, sizes: Mapping[str, int], rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Row numbers per subset: the outer shell of the commands is extrapolation, in their order; the rest at random."""
    by_norm = np.argsort(np.linalg.norm(commands, axis=1), kind="stable")
    inner = len(commands) - sizes[EXTRAPOLATION]
    cuts = np.cumsum([sizes[TRAIN], sizes[VALIDATION]])
    train, validation, test = np.split(rng.permutation(by_norm[:inner]), cuts)
    return {TRAIN: train, VALIDATION: validation, TEST: test, EXTRAPOLATION: np.sort(by_norm[inner:])}
