"""A robust polynomial fit of poses by commands: what a pose should be, by the rows around it.

Least squares on commands scaled to [-1, 1], refitted without the rows that lie far off (Rousseeuw and Leroy 1987,
*Robust Regression and Outlier Detection*, reweighted least squares). It is no point model: it only finds the rows
that do not belong.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from softkin.core.rows import Indices, chunks, sampled_rows
from softkin.core.samples import CONSTANT_RANGE_MM, Array

MAX_DEGREE, MAX_TERMS, ROWS_PER_TERM, ROWS_PER_LINEAR_TERM = 8, 250, 8, 3
MAX_ROWS_FITTED = 10_000
MAX_REFITS = 10
#: A refit leaves out the rows that are farther off than both, in any coordinate: robust standard deviations, share of
#: the extent. The second keeps the corners in, where a noiseless robot's fit is worst and would be worse without them.
REFIT_SCALES, REFIT_SHARE = 8.0, 0.01


@dataclass(frozen=True, slots=True)
class SmoothFit:
    """A fitted polynomial; at `degree` 0 the rows were too few for one.

    `scale` (n_coordinates,) is the robust standard deviation of a residual; `extent` (n_coordinates,) is the width of
    the middle 90 % of positions, or of all where these do not move; both in mm.
    """

    degree: int
    n_fitted: int
    centre: Array
    half_range: Array
    coefficients: Array
    last_degree: Array
    root: Array
    scale: Array
    extent: Array

    def residuals(self, commands: Array, positions: Array) -> Array:
        """Measured minus expected position (n_rows, n_coordinates) in mm."""
        result = np.empty_like(positions)
        for part in chunks(len(commands)):
            result[part] = positions[part] - self._terms(commands[part]) @ self.coefficients
        return result

    def limits(self, commands: Array, scales: float) -> Array:
        """How far a good row may lie from the fit (n_rows, n_coordinates) in mm, with `scales` standard deviations.

        The standard deviation of a prediction is that of a residual times sqrt(1 + leverage): wide where rows are few.
        To it is added what the polynomial itself may be off: as much, relative to the extent and in the worst
        coordinate, as its highest degree changed it, the usual estimate of what a cut-off series leaves out.
        """
        terms = self._terms(commands)
        leverage = np.square(terms @ self.root).sum(axis=1)
        left_out = (np.abs(terms @ self.last_degree) / self.extent).max(axis=1)
        return np.asarray(scales * np.sqrt(1.0 + leverage)[:, None] * self.scale + left_out[:, None] * self.extent)

    def _terms(self, commands: Array) -> Array:
        return _terms((commands - self.centre) / self.half_range, self.degree)


def fit_smoothly(commands: Array, positions: Array, rows: Indices, seed: int = 0) -> SmoothFit:
    """The polynomial fitted to `rows` (at most `MAX_ROWS_FITTED` of them, drawn with `seed`) of commands (n_rows,
    n_commands) and positions (n_rows, n_coordinates) in mm.
    """
    from scipy.linalg import lstsq, pinv

    rows = rows[sampled_rows(len(rows), MAX_ROWS_FITTED, seed)]
    x, y = commands[rows], positions[rows]
    centre, half_range = (x.max(axis=0) + x.min(axis=0)) / 2, np.ptp(x, axis=0) / 2
    half_range = np.where(half_range > 0, half_range, 1.0)
    degree = degree_for(len(rows), commands.shape[1])
    terms = _terms((x - centre) / half_range, degree)
    extent = np.subtract(*np.percentile(y, [95, 5], axis=0))
    extent = np.where(extent > 0, extent, np.maximum(np.ptp(y, axis=0), CONSTANT_RANGE_MM))
    kept = np.ones(len(rows), dtype=bool)
    for _ in range(MAX_REFITS):
        coefficients = lstsq(terms[kept], y[kept], lapack_driver="gelsy")[0]
        errors = np.abs(y - terms @ coefficients)
        # The floor stands for rounding: a noiseless line fits to the last bit, and that bit is no scale.
        scale = np.maximum(1.4826 * np.median(errors[kept], axis=0), 1e-12 * np.abs(y).max(axis=0) + 1e-300)
        now_kept = (errors <= np.maximum(REFIT_SCALES * scale, REFIT_SHARE * extent)).all(axis=1)
        if now_kept.sum() < max(len(rows) // 2, terms.shape[1]) or (now_kept == kept).all():
            break
        kept = now_kept
    # terms @ root has the leverages as squared lengths of its rows.
    root = pinv(np.linalg.qr(terms[kept], mode="r"))
    last_degree = coefficients.copy()
    if degree:
        lower = terms[:, : comb(x.shape[1] + degree - 1, degree - 1)]  # PolynomialFeatures orders terms by degree
        last_degree[: lower.shape[1]] -= lstsq(lower[kept], y[kept], lapack_driver="gelsy")[0]
    return SmoothFit(degree, len(rows), centre, half_range, coefficients, last_degree, root, scale, extent)


def degree_for(n_rows: int, n_commands: int) -> int:
    """Highest degree that leaves `ROWS_PER_TERM` rows for each term; a plane makes do with `ROWS_PER_LINEAR_TERM`."""
    most = min(MAX_TERMS, n_rows // ROWS_PER_TERM)
    degree = max(d for d in range(MAX_DEGREE + 1) if d == 0 or comb(n_commands + d, d) <= most)
    return degree or int(n_rows >= ROWS_PER_LINEAR_TERM * (n_commands + 1))


def _terms(scaled: Array, degree: int) -> Array:
    from sklearn.preprocessing import PolynomialFeatures

    return np.asarray(PolynomialFeatures(degree).fit_transform(scaled))
