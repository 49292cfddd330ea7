from __future__ import annotations

import numpy as np

from softkin.models import huber, linear
from softkin.models.huber import MAX_ITER, SPEC
from tests.conftest import bending_arm


def test_gross_errors_hardly_move_its_fit() -> None:
    """5 % of the rows of train are off by five standard deviations; least squares on the same powers follows them."""
    rows, clean = bending_arm(200), bending_arm(100, seed=1)
    mean, scale = rows.positions.mean(axis=0), rows.positions.std(axis=0)
    targets, wrong = (rows.positions - mean) / scale, (rows.positions - mean) / scale
    wrong[::20] += 5.0
    errors = {}
    for spec, params in ((huber.SPEC, {"degree": 3, "epsilon": 1.35, "alpha": 1e-4}), (linear.SPEC, {"degree": 3})):
        fits = [spec.build(params, 0, 1).fit(rows.commands, y).predict(clean.commands) for y in (targets, wrong)]
        errors[spec.name] = np.abs(fits[1] - fits[0]).mean()
    assert errors["huber"] < 0.1 * errors["lr"]


def test_it_is_marked_as_robust_and_least_squares_is_not() -> None:
    assert SPEC.is_robust
    assert not linear.SPEC.is_robust


def test_each_coordinate_has_a_regressor_of_its_own_on_shared_powers() -> None:
    rows = bending_arm(60, n_commands=3)
    pipeline = SPEC.build({"degree": 2, "epsilon": 1.5, "alpha": 1e-3}, 0, 1).fit(rows.commands, rows.positions)
    features, regressors = pipeline[0], pipeline[-1].estimators_
    assert len(regressors) == 3
    assert len(features.terms_) == 9  # 3 commands, 3 squares, 3 products
    assert {(each.epsilon, each.alpha, each.max_iter) for each in regressors} == {(1.5, 1e-3, MAX_ITER)}
