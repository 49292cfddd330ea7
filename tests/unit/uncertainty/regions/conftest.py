"""Made-up residuals of two markers."""

from __future__ import annotations

import numpy as np

from softkin.core.samples import Array

MARKERS = np.array([0, 0, 0, 2, 2, 2])
ONE_MARKER = np.zeros(3, dtype=np.intp)


def residuals(n: int, seed: int) -> Array:
    """Two markers, the second ten times as far off, the coordinates of each correlated."""
    rng = np.random.default_rng(seed)
    mixed = rng.standard_normal((n, 6)) @ (np.eye(6) + 0.5 * np.kron(np.eye(2), np.ones((3, 3))))
    return np.asarray(mixed * np.repeat([1.0, 10.0], 3))


def on_a_sphere(n: int, radius: float) -> Array:
    """Residuals of one marker, all of the same length."""
    rows = np.random.default_rng(0).standard_normal((n, 3))
    return np.asarray(rows * radius / np.linalg.norm(rows, axis=1, keepdims=True))
