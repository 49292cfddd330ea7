from __future__ import annotations

from typing import Any

import numpy as np
from sklearn.ensemble._hist_gradient_boosting.binning import _BinMapper

from softkin.core.samples import Array
from softkin.models.estimators.histogram_trees import Grower, leaves_of


def grower_of(X: Array, **settings: Any) -> Grower:
    mapper = _BinMapper(n_threads=1)
    wanted = {"max_depth": 3, "min_samples_leaf": 2, "max_features": 1.0, "l2_regularization": 0.0} | settings
    return Grower(mapper.fit_transform(X), mapper, rng=np.random.default_rng(0), threads=1, **wanted)


def test_leaves_hold_all_rows_from_left_to_right_and_records_say_where_they_are() -> None:
    X = np.random.default_rng(0).uniform(-1, 1, (60, 2))
    grower = grower_of(X)
    grower.gradients[:] = X[:, 0] > 0
    root = grower.grow()
    leaves = leaves_of(root)
    found: list[Any] = []
    assert sum(leaf.n_rows for leaf in leaves) == 60
    np.testing.assert_array_equal(np.concatenate([np.asarray(leaf.rows) for leaf in leaves]), grower.rows)
    np.testing.assert_array_equal(np.sort(grower.rows), np.arange(60))
    grower.records(root, found)
    assert len(found) == 2 * len(leaves) - 1
    assert [record[0] for record in found if record[9]] == [leaf.value for leaf in leaves]


def test_one_tree_knows_nothing_of_the_tree_before() -> None:
    X = np.random.default_rng(1).uniform(-1, 1, (60, 2))
    grower = grower_of(X, max_features=0.5)
    first, again = grower_of(X), grower_of(X)
    for one in (first, again):
        one.gradients[:] = X[:, 1]
    values = [leaf.value for leaf in leaves_of(first.grow())]
    again.grow()
    assert [leaf.value for leaf in leaves_of(again.grow())] == values
    grower.gradients[:] = 0.0  # equal gradients leave nothing to split
    assert len(leaves_of(grower.grow())) == 1
