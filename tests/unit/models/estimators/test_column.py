from __future__ import annotations

import numpy as np
import pytest
from sklearn.base import clone
from sklearn.utils.validation import check_is_fitted

from softkin.models.estimators.column import Column

PREDICTIONS = np.arange(12.0).reshape(4, 3)


@pytest.mark.parametrize("index", range(3))
def test_it_predicts_a_column_of_its_input_before_any_fit_and_after(index: int) -> None:
    model = Column(index)
    check_is_fitted(model)
    np.testing.assert_array_equal(model.predict(PREDICTIONS), PREDICTIONS[:, index])
    assert model.fit(PREDICTIONS[:2] + 5.0, np.zeros(2)) is model
    np.testing.assert_array_equal(model.predict(PREDICTIONS), PREDICTIONS[:, index])


def test_a_clone_predicts_the_same_column() -> None:
    np.testing.assert_array_equal(clone(Column(2)).predict(PREDICTIONS), PREDICTIONS[:, 2])
