"""What to measure next: commands between the bounds of `train` that lie far from all that was measured."""

from __future__ import annotations

from numbers import Integral
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial import KDTree
from scipy.stats import qmc

from softkin.core.errors import ConfigError, DataError
from softkin.core.samples import Array, command_columns, informative_coordinates
from softkin.core.units import own_unit
from softkin.uncertainty import calls

#: Commands that suggestions are taken from: as many as this, or as this multiple of the suggestions.
FEWEST_CANDIDATES, CANDIDATES_EACH = 2048, 4
MOST_ROWS = 10_000
#: Poses that more probably fail than not tell nothing of where the robot is.
FAILS = 0.5


class Suggestions:
    """What a calibrated model answers to the question of what to measure next."""

    def suggest(
        self: Any, n_rows: int = 50, *, inside: bool = False, confidence: float = 0.9, seed: int = 0
    ) -> pd.DataFrame:
        """Commands worth measuring, the most telling first: a DataFrame with a row for each.

        Each is the one that lies farthest from the commands of `train` and from the suggestions before it, of 2048
        points of a scrambled Sobol' sequence between the bounds of `train` (Johnson, Moore and Ylvisaker 1990, greedy).
        Commands at which the pose more probably fails than not are left out. The first rows of more are those of fewer,
        up to 512. Source of the choice: docs/decisions/0037-commands-worth-measuring.md.

        Columns: the commands by the robot's own names, else (or where these are names of other columns) u1, u2, ...;
        `distance` to the nearest command of `train` or suggested before, each command in units of its range on `train`;
        `width_mm`, the mean width of the intervals of moving coordinates there, as the model is now, of a robot that
        remembers from rest; `outside`, the command lies in extrapolation: whether the robot can take it nothing says;
        `unit` of the width, where it is not mm.

        Parameters:
            n_rows: how many, from 1 to 10,000.
            inside: only commands in-domain.
            confidence: level of the intervals.
            seed: of the sequence.

        Raises:
            ConfigError: no such number, level or seed.
            DataError: no command varies on `train`, or too few commands are in-domain.
        """
        n_rows = _whole(n_rows, "number of rows", 1, MOST_ROWS, self.dataset)
        seed = _whole(seed, "seed", 0, 2**32 - 1, self.dataset)
        level = calls.level_of(confidence, self.dataset)
        candidates = self._candidates(n_rows, seed, inside=inside)
        lower, width = _box(self.train.commands)
        places, distances = farthest((self.train.commands - lower) / width, (candidates - lower) / width, n_rows)
        commands = candidates[places]
        bounds = np.asarray(self.intervals(commands, level))[:, informative_coordinates(self.train.positions)]
        told: dict[str, Any] = {
            "distance": distances,
            "width_mm": (bounds[..., 1] - bounds[..., 0]).mean(axis=1),
            "outside": np.asarray(self.is_outside(commands)),
        }
        told |= own_unit(self.names.unit)
        own = list(self.names.own_commands)
        names = own if own and not set(own) & set(told) else command_columns(commands.shape[1])
        return pd.DataFrame(commands, columns=names).assign(**told)

    def _candidates(self: Any, n_rows: int, seed: int, *, inside: bool) -> Array:
        """Commands (n_candidates, n_commands) that may be suggested."""
        train = self.train.commands
        lower, width = _box(train)
        free = np.ptp(train, axis=0) > 0
        if not free.any():
            raise DataError(
                "no command varies on train", where=self.dataset, fix="record poses at other commands, and run again"
            )
        n_points = max(FEWEST_CANDIDATES, CANDIDATES_EACH * n_rows)
        sequence = qmc.Sobol(int(free.sum()), rng=np.random.default_rng(seed))
        commands = np.tile(lower, (2 ** int(np.ceil(np.log2(n_points))), 1))
        commands[:, free] += sequence.random(len(commands)) * width[free]
        kept = ~np.asarray(self.is_outside(commands)) if inside else np.ones(len(commands), dtype=bool)
        failing = self.failure_probability(commands)
        kept &= True if failing is None else np.asarray(failing) <= FAILS
        if kept.sum() < n_rows:
            raise DataError(
                f"{kept.sum()} of {len(commands)} commands between the bounds of train may be suggested",
                where=self.dataset,
                fix=f"ask for fewer rows than {n_rows}" + (", or also for commands outside" if inside else ""),
            )
        return np.asarray(commands[kept])


def farthest(measured: Array, candidates: Array, n_rows: int) -> tuple[NDArray[np.intp], Array]:
    """Greedy: the candidates (n_rows,) that each lie farthest from what was measured and from those before, and how far
    (n_rows,).

    Parameters:
        measured, candidates: points (n_points, n_dimensions).
    """
    distances = np.asarray(KDTree(measured).query(candidates)[0])
    places, far = np.empty(n_rows, dtype=np.intp), np.empty(n_rows)
    for row in range(n_rows):
        places[row] = place = int(np.argmax(distances))
        far[row] = distances[place]
        distances = np.minimum(distances, np.linalg.norm(candidates - candidates[place], axis=1))
    return places, far


def _box(commands: Array) -> tuple[Array, Array]:
    """Lower bounds and ranges (n_commands,); a command that never varies has the range 1."""
    lower, width = commands.min(axis=0), np.ptp(commands, axis=0)
    return lower, np.where(width > 0, width, 1.0)


def _whole(value: Any, what: str, least: int, most: int, where: str) -> int:
    if isinstance(value, Integral) and not isinstance(value, bool) and least <= int(value) <= most:
        return int(value)
    raise ConfigError(f"{value!r} is no {what}", where=where, fix=f"pass a whole number from {least} to {most}")
