"""How errors grow with the distance beyond what a model was fitted on: a law read off the shells of `train`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softkin.interface import Array, ShellEvidence

#: Errors smaller than this share of a coordinate's median one count as that: their logarithm says nothing.
LEAST_SHARE = 1e-3
#: Smallest error, mm.
TINY_MM = 1e-12


@dataclass(frozen=True, slots=True)
class Growth:
    """Error proportional to reach^`reach` * distance^`distance`, each (n_coordinates,).

    `reach` is how far out the core goes, in units of how far `train` goes; the distance of a command is its norm in
    units of the core's reach. `distance` is at least 0, so that an interval never narrows along a ray that leaves the
    core. `largest` is the reach of the largest core.
    """

    reach: Array
    distance: Array
    largest: float

    def of_shell(self, reach: float, distances: Array) -> Array:
        """Difficulty (n_rows, n_coordinates) of the rows of a shell, around a core of this reach."""
        return np.asarray(np.exp(self.reach * np.log(reach) + np.outer(np.log(distances), self.distance)))

    def of_new(self, distances: Array) -> Array:
        """Difficulty (n_rows, n_coordinates) of new rows for the model fitted on all of `train`.

        Errors that shrank from core to core count as those of the largest: no law makes a model better than the best
        that was seen.
        """
        best_seen = np.where(self.reach < 0, self.reach * np.log(self.largest), 0.0)
        return np.asarray(np.exp(best_seen + np.outer(np.log(distances), self.distance)))


def reach(evidence: ShellEvidence) -> float:
    """How far out `train` goes: the largest norm of its commands."""
    assert evidence.deployed.train_commands is not None
    return float(evidence.norm(evidence.deployed.train_commands).max())


def new_distances(evidence: ShellEvidence) -> Array:
    """Norms (n_rows,) of the new commands in units of the reach of `train`, at least 1."""
    assert evidence.deployed.new_commands is not None
    return np.maximum(evidence.norm(evidence.deployed.new_commands) / reach(evidence), 1.0)


def shell_distances(evidence: ShellEvidence) -> list[tuple[float, Array]]:
    """Reach of each core in units of that of `train`, and the distances (n_shell,) of its shell's rows, above 1."""
    found = []
    for shell in evidence.shells:
        core = float(evidence.norm(shell.core_commands).max())
        found.append((core / reach(evidence), evidence.norm(shell.commands) / core))
    return found


def growth_laws(evidence: ShellEvidence) -> list[Growth]:
    """Two laws: one of each coordinate, and one that all share, which few rows tell better. By least squares of the
    logarithm of the errors, of each coordinate and of all in units of their 90 % quantiles.
    """
    errors = np.concatenate([np.abs(shell.truth - shell.predicted) for shell in evidence.shells])
    places = shell_distances(evidence)
    reaches = np.concatenate([np.full(len(distances), np.log(core)) for core, distances in places])
    distances = np.log(np.concatenate([distances for _, distances in places]))
    scale = np.maximum(np.quantile(errors, 0.9, axis=0), TINY_MM)
    together = np.sqrt(np.mean((errors / scale) ** 2, axis=1))
    least = np.maximum(LEAST_SHARE * np.median(errors, axis=0), TINY_MM)
    own = np.array([slopes(np.maximum(e, low), reaches, distances) for e, low in zip(errors.T, least, strict=True)])
    shared = slopes(np.maximum(together, LEAST_SHARE * max(float(np.median(together)), TINY_MM)), reaches, distances)
    largest = max(core for core, _ in places)
    n_coordinates = errors.shape[1]
    return [
        Growth(own[:, 0], own[:, 1], largest),
        Growth(np.full(n_coordinates, shared[0]), np.full(n_coordinates, shared[1]), largest),
    ]


def slopes(errors: Array, log_reaches: Array, log_distances: Array) -> Sequence[float]:
    """Slopes of log(errors) (n_rows,), which are above 0, in reach and distance; that of the distance at least 0."""
    logs = np.log(errors)
    constant = np.ones_like(logs)

    def fitted(*columns: Array) -> list[float]:
        return [float(slope) for slope in np.linalg.lstsq(np.column_stack([constant, *columns]), logs)[0][1:]]

    by_reach, by_distance = fitted(log_reaches, log_distances)
    return (by_reach, by_distance) if by_distance >= 0 else (fitted(log_reaches)[0], 0.0)
