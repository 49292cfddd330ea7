from __future__ import annotations

import numpy as np
from sklearn.base import clone
from sklearn.multioutput import MultiOutputRegressor
from sklearn.svm import SVR
from sklearn.tree import DecisionTreeRegressor

from softkin.models.estimators.per_target import PerTarget

RNG = np.random.default_rng(0)
COMMANDS, TARGETS = RNG.standard_normal((50, 2)), RNG.standard_normal((50, 3))


def test_it_predicts_what_scikit_learns_does() -> None:
    fitted, expected = (kind(SVR()).fit(COMMANDS, TARGETS) for kind in (PerTarget, MultiOutputRegressor))
    np.testing.assert_array_equal(fitted.predict(COMMANDS[:9]), expected.predict(COMMANDS[:9]))
    assert len(fitted.estimators_) == 3


def test_a_single_target_keeps_its_shape() -> None:
    tree = DecisionTreeRegressor(random_state=0)
    flat, column = (PerTarget(tree).fit(COMMANDS, targets) for targets in (TARGETS[:, 0], TARGETS[:, :1]))
    assert flat.predict(COMMANDS).shape == (50,)
    assert column.predict(COMMANDS).shape == (50, 1)
    np.testing.assert_array_equal(flat.predict(COMMANDS), column.predict(COMMANDS)[:, 0])


def test_the_regressor_itself_stays_unfitted() -> None:
    model = PerTarget(SVR(C=3.0))
    model.fit(COMMANDS, TARGETS)
    assert not hasattr(model.regressor, "support_")
    assert clone(model).regressor.C == 3.0
