"""The type of a stand-in, and ways to draw its commands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from softkin.core.samples import Array


@dataclass(frozen=True, slots=True)
class StandIn:
    """A simulated robot.

    `draw(n_rows, rng)` returns commands (n_rows, n_commands), all distinct, in the order in which they are sent.
    `poses(commands, rng)` returns positions (n_rows, 3 * n_markers) in mm; a robot with memory starts from rest and
    depends on that order. `title` is what tables call it. `sessions` are the shares of the rows of each
    session of a recording: it begins at rest, and its zero is off by `zero_mm` (n_coordinates,), standard deviations.
    """

    name: str
    title: str
    n_commands: int
    n_markers: int
    draw: Callable[[int, np.random.Generator], Array]
    poses: Callable[[Array, np.random.Generator], Array]
    sessions: tuple[float, ...] = ()
    zero_mm: tuple[float, ...] = ()


def evenly(n_rows: int, n_commands: int, rng: np.random.Generator) -> Array:
    """Points (n_rows, n_commands) that fill [0, 1) evenly: a scrambled Halton sequence, in random order.

    In its own order each point lies away from the one before, so that a robot with hysteresis would approach every
    command from one side.
    """
    from scipy.stats import qmc

    return rng.permutation(qmc.Halton(n_commands, scramble=True, rng=rng).random(n_rows))


def in_box(n_rows: int, lower: Sequence[float], upper: Sequence[float], rng: np.random.Generator) -> Array:
    """Commands (n_rows, n_commands) between `lower` and `upper`, each (n_commands,)."""
    from scipy.stats import qmc

    return np.asarray(qmc.scale(evenly(n_rows, len(lower), rng), lower, upper))


def in_disc(n_rows: int, radius: float, rng: np.random.Generator) -> Array:
    """Pairs of commands (n_rows, 2) whose norm is uniform up to `radius`, in all directions."""
    share, turn = evenly(n_rows, 2, rng).T
    angle = 2 * np.pi * turn
    return np.asarray(radius * share * np.stack([np.cos(angle), np.sin(angle)])).T
