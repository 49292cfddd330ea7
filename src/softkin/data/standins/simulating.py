"""Simulate a stand-in: its name -> samples per subset in mm, split as the published data are."""

from __future__ import annotations

import logging
from collections.abc import Mapping

import numpy as np

from softkin.core.errors import ConfigError
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, VALIDATION, Array, Samples
from softkin.data.recordings import recording_of
from softkin.data.standins import STANDINS
from softkin.data.standins.robot import StandIn

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
    samples = (
        in_sessions(robot, commands, measuring)
        if robot.sessions
        else Samples(commands, robot.poses(commands, measuring))
    )
    return {subset: samples.take(rows) for subset, rows in split(commands, sizes, splitting).items()}


def in_sessions(robot: StandIn, commands: Array, rng: np.random.Generator) -> Samples:
    """Poses of `commands` (n_rows, n_commands), recorded in this order in the robot's sessions."""
    ends = np.round(np.cumsum(robot.sessions)[:-1] * len(commands)).astype(int)
    parts = [part for part in np.split(np.arange(len(commands)), ends) if len(part)]
    zeros = rng.standard_normal((len(parts), len(robot.zero_mm))) * robot.zero_mm
    positions = np.concatenate(
        [robot.poses(commands[part], rng) + zero for part, zero in zip(parts, zeros, strict=True)]
    )
    session = np.repeat(np.arange(1, len(parts) + 1), [len(part) for part in parts])
    return Samples(commands, positions, recording_of(commands, None, session, lambda row: f"row {row}"))


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
