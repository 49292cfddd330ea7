from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.stats import binom

from softkin.core.samples import Samples
from softkin.models.of_orientation import CANDIDATES
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.orientation_model import OrientationModel
from softkin.uncertainty.promise import Promise
from tests.oriented_robot import about_one_mean, oriented_arm

N_CALIBRATION, N_DRAWS = 49, 200


@cache
def model() -> tuple[OrientationModel, Samples]:
    """A model without a calibration set, and rows that it has not seen."""
    rows, mean = about_one_mean(
        {"train": oriented_arm(100), "new": oriented_arm(N_DRAWS * (N_CALIBRATION + 1), seed=3)}
    )
    spec, params = CANDIDATES[1]
    turned = replace(rows["train"], positions=np.asarray(rows["train"].orientation))
    estimator = fitted_model(spec, FitSettings(params, True, 0, 1), turned)
    return OrientationModel(spec.name, params, estimator, mean, np.empty(0), None, np.empty(0)), rows["new"]


@pytest.mark.parametrize("level", [0.8, 0.9])
def test_coverage_of_the_angle_is_within_the_exact_band(level: float) -> None:
    """Each draw has a calibration set and a new row of its own, so that the count of covered rows is binomial."""
    bare, rows = model()
    drawn = bare.angles(rows).reshape(N_DRAWS, N_CALIBRATION + 1)
    held = sum(row[-1] <= replace(bare, scores=row[:-1]).bound(level) for row in drawn)
    lowest, highest = binom.interval(0.999, N_DRAWS, level)
    assert lowest <= held <= highest


def test_the_promise_is_that_of_the_split() -> None:
    bare, _ = model()
    scores = np.arange(1.0, 10.0)
    assert replace(bare, scores=scores).bound(0.9) == 9.0
    assert replace(bare, scores=scores).bound(0.95) == np.inf
    assert replace(bare, scores=scores).guarantee(0.9) == "marginal"
    few = replace(bare, scores=np.repeat(scores[:3], 3), promise=Promise(3, 3))
    assert few.bound(0.9) == 3.0
    assert few.guarantee(0.9) == "no guarantee (3 blocks)"
    assert replace(few, promise=Promise(9, 3)).guarantee(0.9) == "marginal, by block"
