from __future__ import annotations

import numpy as np
import pytest
from optuna.trial import FixedTrial
from sklearn.exceptions import ConvergenceWarning
from sklearn.svm import SVR

from softkin.models.svr import MAX_ITER, SPEC, build
from tests.conftest import bending_arm

FIRST = {"trend": "none", "C": 10.0, "epsilon": 0.01, "gamma": 0.3}


def test_one_regressor_per_coordinate_with_scikit_learns_settings_for_the_paper() -> None:
    rows = bending_arm(60)
    fitted = build({**SPEC.paper_params}, 0, 1).fit(rows.commands, rows.positions)
    assert len(fitted.estimators_) == 3
    expected = SVR().fit(rows.commands, rows.positions[:, 1]).predict(rows.commands)
    np.testing.assert_allclose(fitted.predict(rows.commands)[:, 1], expected, rtol=1e-9)


def test_far_away_an_rbf_kernel_ends_at_a_constant_and_a_polynomial_one_goes_on() -> None:
    commands = np.random.default_rng(0).uniform(-1, 1, (80, 1))
    targets = np.column_stack([commands[:, 0], commands[:, 0] ** 2])
    far = np.array([[20.0], [30.0]])
    rbf = build({"kernel": "rbf", "gamma": 1.0}, 0, 1).fit(commands, targets).predict(far)
    np.testing.assert_allclose(rbf[0], rbf[1], atol=1e-9)
    params = {"kernel": "poly", "degree": 2, "coef0": 1.0, "gamma": 0.3, "C": 10.0, "epsilon": 0.01}
    poly = build(params, 0, 1).fit(commands, targets).predict(far)
    np.testing.assert_allclose(poly, np.column_stack([far[:, 0], far[:, 0] ** 2]), rtol=0.1)


def test_only_a_polynomial_kernel_has_a_degree_and_every_search_is_bounded() -> None:
    rbf = SPEC.search_space(FixedTrial({**FIRST, "kernel": "rbf"}))
    poly = SPEC.search_space(FixedTrial({**FIRST, "kernel": "poly", "degree": 3}))
    assert set(poly) - set(rbf) == {"degree", "coef0"}
    assert rbf["max_iter"] == poly["max_iter"] == MAX_ITER


def test_the_bound_stops_the_solver_and_is_none_for_the_paper() -> None:
    rows = bending_arm(60)
    with pytest.warns(ConvergenceWarning):
        build({"C": 100.0, "epsilon": 1e-3, "max_iter": 2}, 0, 1).fit(rows.commands, rows.positions)
    assert build({**SPEC.paper_params}, 0, 1).regressor.max_iter == -1
