from __future__ import annotations

import numpy as np
from xgboost import XGBRegressor

from softkin.models.plain.describe_trees import of_xgboost
from softkin.models.plain.evaluate import regressor

X = np.random.default_rng(0).normal(size=(80, 2))


def test_xgboost_is_the_same_to_the_bit_also_at_its_thresholds() -> None:
    model = XGBRegressor(n_estimators=9, max_depth=3, n_jobs=1).fit(X, np.column_stack([X[:, 0] ** 2, X.sum(axis=1)]))
    node = of_xgboost([model], None)
    edges = node["threshold"][np.isfinite(node["threshold"])]
    beside = np.nextafter(edges.astype(np.float32), np.float32(np.inf)).astype(np.float64)
    rows = np.vstack([X, np.column_stack([edges, edges]), np.column_stack([beside, beside])])
    np.testing.assert_array_equal(regressor(node)(rows)[0], model.predict(rows))
