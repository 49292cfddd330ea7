"""Error-growth model: how errors grow with the distance beyond the core that a model was fitted on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.calibration_data import ShellCalibration

#: Smallest error, mm.
TINY_MM = 1e-12
#: Penalty that keeps coefficients near 0 that no row identifies, such as slopes where all distances are alike.
RIDGE = 1e-8
#: An error counts at most as so many times what the fit predicts: gross errors (a stuck pose) are capped.
CAP = 3.0
MAX_CAPPINGS = 10


@dataclass(frozen=True, slots=True)
class ErrorGrowth:
    """Error proportional to core^`core_exponent` * exp(`slope` x + `bend` x^2), x = log(distance), coefficients
    (n_coordinates,).

    core is the radius (largest command norm) of the core in units of that of `train`; the distance of a command is its
    norm in units of the radius of the core. Beyond `largest_log_distance`, that of all shells, log error continues as a
    straight line in x, and never falls: an interval never narrows along a ray that leaves the core. `largest_core` is
    that of all cores.
    """

    core_exponent: Array
    slope: Array
    bend: Array
    largest_core: float
    largest_log_distance: float

    def of_shell(self, core: float, distances: Array) -> Array:
        """Difficulty (n_rows, n_coordinates) of the rows of a shell at distances (n_rows,) beyond this core."""
        return np.asarray(np.exp(self.core_exponent * np.log(core) + self._log_error(distances)))

    def of_new(self, distances: Array) -> Array:
        """Difficulty (n_rows, n_coordinates) of new rows for the model fitted on all of `train`, whose core is 1.

        Where errors shrink from core to core (a negative exponent) it is that of the largest core: no model is taken to
        be better than the best one that was measured.
        """
        floor = np.where(self.core_exponent < 0, self.core_exponent * np.log(self.largest_core), 0.0)
        return np.asarray(np.exp(floor + self._log_error(distances)))

    def _log_error(self, distances: Array) -> Array:
        x = np.log(distances)[:, None]
        near = np.minimum(x, self.largest_log_distance)
        beyond = (x - near) * (self.slope + 2 * self.bend * self.largest_log_distance)
        return np.asarray(near * self.slope + near**2 * self.bend + beyond)


def train_radius(data: ShellCalibration) -> float:
    """Largest norm of the commands of `train`."""
    return float(data.norm(data.deployed.train_commands).max())


def new_distances(data: ShellCalibration) -> Array:
    """Norms (n_rows,) of the new commands in units of the radius of `train`, at least 1."""
    return np.maximum(data.norm(data.deployed.new_commands) / train_radius(data), 1.0)


def shell_distances(data: ShellCalibration) -> list[tuple[float, Array]]:
    """Radius of each core in units of that of `train`, and distances (n_shell,) of the rows of its shell, above 1."""
    places = []
    for shell in data.shells:
        radius = float(data.norm(shell.core_commands).max())
        places.append((radius / train_radius(data), data.norm(shell.commands) / radius))
    return places


def fit_error_growth(data: ShellCalibration) -> list[ErrorGrowth]:
    """Two error-growth models: one with coefficients for each coordinate, one with coefficients that all share.

    The first is fitted to the errors of each coordinate, the second, for which few rows suffice, to the root mean
    square over coordinates of errors in units of their 90 % quantiles. Each shell has the same total weight.
    """
    errors = np.concatenate([np.abs(shell.truth - shell.predicted) for shell in data.shells])
    places = shell_distances(data)
    log_cores = np.concatenate([np.full(len(distances), np.log(core)) for core, distances in places])
    log_distances = np.log(np.concatenate([distances for _, distances in places]))
    weights = np.concatenate([np.full(len(distances), 1 / len(distances)) for _, distances in places])
    scale = np.maximum(np.quantile(errors, 0.9, axis=0), TINY_MM)
    together = np.sqrt(np.mean((errors / scale) ** 2, axis=1))
    n_coordinates = errors.shape[1]
    models = []
    for columns in (errors, together[:, None]):
        fits = [growth_coefficients(c, log_cores, log_distances, weights) for c in np.maximum(columns, TINY_MM).T]
        exponent, slope, bend = np.broadcast_to(np.array(fits), (n_coordinates, 3)).T
        largest_core = max(core for core, _ in places)
        models.append(ErrorGrowth(exponent, slope, bend, largest_core, float(log_distances.max())))
    return models


def growth_coefficients(
    errors: Array, log_cores: Array, log_distances: Array, weights: Array
) -> tuple[float, float, float]:
    """Core exponent, slope and bend of an error-growth model, of one column of errors (n_rows,) above 0.

    The fit must not fall within the distances of the rows: where it does, it is repeated without a bend, and where it
    still does, without a slope. Maximum likelihood of exponentially distributed errors, gross ones capped: a gamma
    regression with a logarithmic link. Least squares of their logarithms would give most weight to the smallest errors,
    those that happen to cross zero. Where there is one core no row identifies its exponent, which is 0.
    """
    terms = np.column_stack([log_cores, log_distances, log_distances**2])
    first = int(np.ptp(log_cores) == 0)
    coefficients = np.zeros(3)
    for n_terms in (3, 2, 1)[: 3 - first]:
        coefficients[:] = 0.0
        coefficients[first:n_terms] = capped_gamma_regression(terms[:, first:n_terms], errors, weights)
        if coefficients[1] >= 0 and coefficients[1] + 2 * coefficients[2] * log_distances.max() >= 0:
            break
    return float(coefficients[0]), float(coefficients[1]), float(coefficients[2])


def capped_gamma_regression(terms: Array, errors: Array, weights: Array) -> Array:
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
