from __future__ import annotations

import numpy as np
from sklearn.linear_model import Lasso

from softkin.models.lasso import MAX_ITER, SPEC, build
from tests.conftest import bending_arm


def test_the_papers_settings_are_a_lasso_on_the_bare_commands() -> None:
    rows = bending_arm(60)
    fitted = build({**SPEC.paper_params}, 0, 1).fit(rows.commands, rows.positions)
    expected = Lasso(alpha=0.1).fit(rows.commands, rows.positions)
    assert isinstance(fitted, Lasso)
    np.testing.assert_allclose(fitted.predict(rows.commands), expected.predict(rows.commands), atol=1e-3)


def test_a_command_without_influence_has_no_weight_in_any_term() -> None:
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (100, 2))
    targets = commands[:, :1] ** 2 + 0.01 * rng.standard_normal((100, 1))
    weights = build({"degree": 2, "alpha": 0.05}, 0, 1).fit(commands, targets)[-1].coef_.ravel()
    assert weights[2] > 0.1  # u1 u1
    np.testing.assert_array_equal(weights[[0, 1, 3, 4]], 0.0)  # u1, u2, u1 u2, u2 u2


def test_one_penalty_suits_features_of_any_scale() -> None:
    """Powers of commands are of very different size: they are standardised before they are penalised."""
    rows = bending_arm(60)
    small, large = (
        build({"degree": 3, "alpha": 1e-3}, 0, 1).fit(factor * rows.commands, rows.positions) for factor in (1, 16)
    )
    np.testing.assert_allclose(large.predict(16 * rows.commands), small.predict(rows.commands), rtol=1e-6, atol=1e-6)


def test_the_descent_of_a_small_penalty_is_bounded() -> None:
    assert build({"degree": 6, "alpha": 1e-6}, 0, 1)[-1].max_iter == MAX_ITER
    assert build({"alpha": 1e-6}, 0, 1).max_iter == MAX_ITER
