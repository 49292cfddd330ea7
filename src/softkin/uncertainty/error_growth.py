"""How errors grow with the distance beyond what a model was fitted on: a law read off the shells of `train`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import ShellCalibration

#: Smallest error, mm.
TINY_MM = 1e-12
#: What keeps terms that no row tells apart (the reach of one core) at 0.
RIDGE = 1e-8
#: A gross error (a stuck pose) counts as so many times what the law says of its place.
CAP = 3.0
MAX_CAPPINGS = 10


@dataclass(frozen=True, slots=True)
class Growth:
    """Error proportional to reach^`reach` * exp(`distance` x + `bend` x^2), each (n_coordinates,), x = log(distance).

    `reach` is how far out the core goes, in units of how far `train` goes; the distance of a command is its norm in
    units of the core's reach. Beyond `farthest`, the largest x of any shell, it goes on as steeply as it got there,
    which is never downwards, so that an interval never narrows along a ray that leaves the core. `largest` is the reach
    of the largest core.
    """

    reach: Array
    distance: Array
    bend: Array
    largest: float
    farthest: float

    def of_shell(self, reach: float, distances: Array) -> Array:
        """Difficulty (n_rows, n_coordinates) of the rows of a shell, around a core of this reach."""
        return np.asarray(np.exp(self.reach * np.log(reach) + self._of(distances)))

    def of_new(self, distances: Array) -> Array:
        """Difficulty (n_rows, n_coordinates) of new rows for the model fitted on all of `train`.

        Errors that shrank from core to core count as those of the largest: no law makes a model better than the best
        that was seen.
        """
        best_seen = np.where(self.reach < 0, self.reach * np.log(self.largest), 0.0)
        return np.asarray(np.exp(best_seen + self._of(distances)))

    def _of(self, distances: Array) -> Array:
        x = np.log(distances)[:, None]
        near = np.minimum(x, self.farthest)
        beyond = (x - near) * (self.distance + 2 * self.bend * self.farthest)
        return np.asarray(near * self.distance + near**2 * self.bend + beyond)


def reach(data: ShellCalibration) -> float:
    """How far out `train` goes: the largest norm of its commands."""
    return float(data.norm(data.deployed.train_commands).max())


def new_distances(data: ShellCalibration) -> Array:
    """Norms (n_rows,) of the new commands in units of the reach of `train`, at least 1."""
    return np.maximum(data.norm(data.deployed.new_commands) / reach(data), 1.0)


def shell_distances(data: ShellCalibration) -> list[tuple[float, Array]]:
    """Reach of each core in units of that of `train`, and the distances (n_shell,) of its shell's rows, above 1."""
    found = []
    for shell in data.shells:
        core = float(data.norm(shell.core_commands).max())
        found.append((core / reach(data), data.norm(shell.commands) / core))
    return found


def growth_laws(data: ShellCalibration) -> list[Growth]:
    """Two laws: one of each coordinate, and one that all share, which few rows tell better. Fitted to the errors of
    each coordinate, and to those of all in units of their 90 % quantiles; each shell counts alike.
    """
    errors = np.concatenate([np.abs(shell.truth - shell.predicted) for shell in data.shells])
    places = shell_distances(data)
    reaches = np.concatenate([np.full(len(distances), np.log(core)) for core, distances in places])
    distances = np.log(np.concatenate([distances for _, distances in places]))
    weights = np.concatenate([np.full(len(distances), 1 / len(distances)) for _, distances in places])
    scale = np.maximum(np.quantile(errors, 0.9, axis=0), TINY_MM)
    together = np.sqrt(np.mean((errors / scale) ** 2, axis=1))
    n_coordinates = errors.shape[1]
    laws = []
    for columns in (errors, together[:, None]):
        slopes = np.array([law(column, reaches, distances, weights) for column in np.maximum(columns, TINY_MM).T])
        by_reach, by_distance, bend = np.broadcast_to(slopes, (n_coordinates, 3)).T
        laws.append(Growth(by_reach, by_distance, bend, max(core for core, _ in places), float(distances.max())))
    return laws


def law(errors: Array, log_reaches: Array, log_distances: Array, weights: Array) -> tuple[float, float, float]:
    """Slope of the logarithm of the mean error in reach; slope and bend in distance, rising as far as there are rows:
    without a bend where it would fall there, without a slope where that would. `errors` (n_rows,) are above 0.

    By maximum likelihood of exponential errors (a gamma regression with a logarithmic link), gross ones capped. Least
    squares of their logarithms would heed most the smallest errors, which tell nothing: those that cross zero.
    """
    terms = np.column_stack([log_reaches, log_distances, log_distances**2])
    found = np.zeros(3)
    for n_terms in (3, 2, 1):
        found[:] = 0.0
        found[:n_terms] = slopes(terms[:, :n_terms], errors, weights)
        if found[1] >= 0 and found[1] + 2 * found[2] * log_distances.max() >= 0:
            break
    return float(found[0]), float(found[1]), float(found[2])


def slopes(terms: Array, errors: Array, weights: Array) -> Array:
    """Coefficients (n_terms,) of the logarithm of the mean error (n_rows,), with errors capped anew after each fit."""
    from sklearn.linear_model import GammaRegressor

    scale = np.quantile(errors, 0.9)
    capped = np.minimum(errors / scale, CAP)
    glm = GammaRegressor(alpha=RIDGE, solver="newton-cholesky", max_iter=300, warm_start=True)
    for _ in range(MAX_CAPPINGS):
        glm.fit(terms, capped, sample_weight=weights)
        before, capped = capped, np.minimum(errors / scale, CAP * glm.predict(terms))
        if np.allclose(capped, before, rtol=1e-3, atol=0.0):
            break
    return np.asarray(glm.coef_)
