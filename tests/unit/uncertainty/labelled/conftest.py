"""A made-up run whose errors grow with the command norm."""

from __future__ import annotations

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.labelled.spec import Labelled
from tests.unit.uncertainty.conftest import norm


def labelled(n: int = 140, m: int = 200, seed: int = 0, norms: tuple[float, float] = (0.0, 1.0)) -> Labelled:
    """Calibration commands have norms up to 1, new ones between the two `norms`."""
    rng = np.random.default_rng(seed)

    def commands(rows: int, low: float, high: float) -> Array:
        angle = rng.uniform(0, 2 * np.pi, rows)
        return np.asarray(rng.uniform(low, high, rows)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))

    def errors(at: Array) -> Array:
        return np.asarray(rng.standard_normal((len(at), 3)) * (0.5 + norm(at))[:, None])

    train, calibration, new = commands(400, 0, 1), commands(n, 0, 1), commands(m, *norms)
    return Labelled(train, calibration, errors(calibration), new, errors(new), norm)
