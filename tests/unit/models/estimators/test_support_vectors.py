from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from sklearn.svm import SVR

from softkin.core import rows
from softkin.models.estimators import support_vectors
from softkin.models.estimators.per_target import PerTarget
from softkin.models.estimators.support_vectors import SupportVectors
from softkin.models.plain.describe import described

RNG = np.random.default_rng(0)
COMMANDS, TARGETS = RNG.uniform(-1, 1, (60, 2)), RNG.standard_normal((60, 3))
NEW = RNG.uniform(-1, 1, (25, 2))


@pytest.mark.parametrize(
    "how",
    [{"kernel": "rbf", "gamma": 0.3}, {"kernel": "rbf"}, {"kernel": "poly", "degree": 2, "coef0": 1.0}],
    ids=["width", "scale", "polynomial"],
)
def test_fitted_on_many_rows_it_predicts_what_libsvm_does(monkeypatch: pytest.MonkeyPatch, how: dict[str, Any]) -> None:
    monkeypatch.setattr(support_vectors, "MANY_ROWS", 59)
    monkeypatch.setattr(support_vectors, "PART", 10)
    model = SupportVectors(SVR(**how, epsilon=0.3)).fit(COMMANDS, TARGETS)
    assert model.is_large_
    expected = PerTarget(SVR(**how, epsilon=0.3)).fit(COMMANDS, TARGETS)
    np.testing.assert_allclose(model.predict(NEW), expected.predict(NEW), rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(model.predict(NEW[:1]), model.predict(NEW)[:1], rtol=1e-12)
    flat = SupportVectors(SVR(**how)).fit(COMMANDS, TARGETS[:, 0])
    assert flat.predict(NEW).shape == (25,)
    np.testing.assert_array_equal(described(model)["weights"], described(expected)["weights"])


def test_fitted_on_as_many_rows_as_published_robots_have_it_is_libsvms_to_the_bit() -> None:
    model = SupportVectors(SVR()).fit(COMMANDS, TARGETS)
    np.testing.assert_array_equal(model.predict(NEW), PerTarget(SVR()).fit(COMMANDS, TARGETS).predict(NEW))
    assert rows.MANY_ROWS > 3_160


def test_a_kernel_of_libsvm_alone_stays_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(support_vectors, "MANY_ROWS", 59)
    model = SupportVectors(SVR(kernel="sigmoid")).fit(COMMANDS, TARGETS)
    np.testing.assert_array_equal(
        model.predict(NEW), PerTarget(SVR(kernel="sigmoid")).fit(COMMANDS, TARGETS).predict(NEW)
    )
