"""A made-up robot that may remember, and whose zero may differ between sessions; recorded in the order of its rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from softkin.core.recording import CommandMemory, play
from softkin.core.samples import Array, Samples

NOISE_MM = 0.1


def recorded_arm(
    n_rows: int,
    *,
    backlash: float = 0.0,
    zeros_mm: Sequence[float] = (0.0,),
    seed: int = 0,
    commands: Array | None = None,
) -> Samples:
    """A smooth arm of two commands from -1 to 1, sent in jumps, or as given.

    `backlash` is the half-width of the play of its drives, in units of the range of commands; each of `zeros_mm` is a
    session of equal length, shifted by so much along x.
    """
    rng = np.random.default_rng(seed)
    commands = rng.uniform(-1, 1, (n_rows, 2)) if commands is None else commands
    sessions = 1 + np.arange(n_rows) * len(zeros_mm) // n_rows
    parts = [commands[sessions == number] for number in np.unique(sessions)]
    moved = np.vstack([play(part, 2 * backlash, np.zeros(2)) if backlash else part for part in parts])
    positions = bent(moved) + NOISE_MM * rng.standard_normal((n_rows, 3))
    positions[:, 0] += np.asarray(zeros_mm)[sessions - 1]
    recording = CommandMemory.of(commands).recorded(commands, np.arange(1, n_rows + 1), sessions)
    return Samples(commands, positions, recording)


def bent(commands: Array) -> Array:
    """Poses (n_rows, 3) in mm of the arm without memory."""
    first, second = commands.T
    return np.column_stack([40 * np.sin(first), 40 * np.sin(second), 100 - 10 * first**2 - 8 * second**2])


def with_recording(subsets: dict[str, Samples], n_sessions: int = 2) -> dict[str, Samples]:
    """The same rows, as if recorded in a random order in sessions of equal length."""
    commands = np.concatenate([rows.commands for rows in subsets.values()])
    order = np.random.default_rng(0).permutation(len(commands)) + 1
    recording = CommandMemory.of(commands).recorded(commands, order, 1 + (order - 1) * n_sessions // len(order))
    ends = np.cumsum([len(rows) for rows in subsets.values()])[:-1]
    places = np.split(np.arange(len(commands)), ends)
    return {
        name: replace(rows, recording=recording.take(place))
        for (name, rows), place in zip(subsets.items(), places, strict=True)
    }
