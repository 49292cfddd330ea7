"""A robot that drifts: where Barber's weights do help."""

from __future__ import annotations

from typing import Any

import numpy as np
from sklearn.linear_model import LinearRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import PolynomialFeatures

from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_limits
from softkin.uncertainty.labelled.fixed_weights import answer
from softkin.uncertainty.labelled.spec import Labelled
from tests.conftest import bending_arm
from tests.unit.uncertainty.conftest import LEVELS
from tests.unit.uncertainty.labelled.conftest import labelled


def drifting(model: Any, seed: int, drift: float, n: int = 300, m: int = 60) -> Labelled:
    """A bending arm whose base creeps sideways by `drift` mm a row from the middle of calibration on, while its `model`
    stays what it was. The `norm` of a row is when it was taken.
    """
    arm = bending_arm(n + m, seed=seed)
    time = np.arange(n + m, dtype=float)
    creep = np.maximum(time - n / 2, 0.0)[:, None] * [drift, 0.0, 0.0]
    errors = arm.positions + creep - model.predict(arm.commands)
    stamps = time[:, None]
    return Labelled(stamps[:n], stamps[:n], errors[:n], stamps[n:], errors[n:], lambda rows: rows[:, 0])


def coverages(drift: float) -> tuple[Array, Array]:
    """Of the drifting coordinate, over 100 robots: with equal weights, and with those that fade."""
    learnt = bending_arm(400, seed=1000)
    model = make_pipeline(PolynomialFeatures(6), LinearRegression()).fit(learnt.commands, learnt.positions)
    equal, fading = [], []
    for seed in range(100):
        rows = drifting(model, seed, drift)
        errors = np.abs(rows.errors[:, 0])
        equal.append((errors <= conformal_limits(np.abs(rows.calibration_errors), [0.9])[0, 0]).mean())
        fading.append((errors <= answer(rows, [0.9], 0).half_widths[0, :, 0]).mean())
    return np.array(equal), np.array(fading)


def test_fading_weights_help_where_a_robot_drifts() -> None:
    equal, fading = coverages(drift=0.002)
    gain = fading - equal
    assert equal.mean() < 0.75
    assert fading.mean() > equal.mean() + 0.1
    assert gain.mean() > 4 * gain.std() / np.sqrt(len(gain))


def test_without_a_drift_they_cost_no_coverage() -> None:
    equal, fading = coverages(drift=0.0)
    assert abs(equal.mean() - 0.9) < 0.02
    assert 0.89 < fading.mean() < 0.94


def test_the_effective_size_is_that_of_a_geometric_series() -> None:
    """Of weights 0.97^k: (1 + 0.97) / (1 - 0.97) rows, however many there are."""
    details = answer(labelled(n=1000), LEVELS, 0).details
    assert abs(details["effective_size"] - 1.97 / 0.03) < 1e-6
