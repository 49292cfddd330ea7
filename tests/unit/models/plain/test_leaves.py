from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.ensemble import GradientBoostingRegressor, HistGradientBoostingRegressor, RandomForestRegressor
from xgboost import XGBRegressor

from softkin.core.samples import Array
from softkin.models.estimators.per_target import PerTarget
from softkin.models.plain import leaves
from softkin.models.plain.describe import described
from softkin.models.plain.evaluate import regressor
from softkin.models.plain.kernels import Node
from softkin.models.plain.leaves import in_order, leaf_finder

RNG = np.random.default_rng(0)
X = np.round(RNG.normal(size=(300, 3)), 2)
Y = np.column_stack([X[:, 0] ** 2, X.sum(axis=1)]) + 0.1 * RNG.normal(size=(300, 2))
MODELS: dict[str, Any] = {
    "forest of deep trees": RandomForestRegressor(5, random_state=0),
    "forest of shallow trees": RandomForestRegressor(5, max_depth=4, random_state=0),
    "boosting by XGBoost": XGBRegressor(n_estimators=9, max_depth=3, n_jobs=1),
    "deep boosting by XGBoost": XGBRegressor(n_estimators=4, max_depth=8, min_child_weight=0, n_jobs=1),
    "gradient boosting": PerTarget(GradientBoostingRegressor(n_estimators=9, max_depth=4)),
    "histogram boosting": PerTarget(HistGradientBoostingRegressor(max_iter=9)),
    "trees of one leaf": PerTarget(HistGradientBoostingRegressor(max_iter=2, min_samples_leaf=200)),
}


@pytest.mark.parametrize("name", MODELS)
def test_one_row_is_answered_as_among_many_and_by_the_library(name: str) -> None:
    """One row by masks, many by walking, to the bit; the library to rounding; at thresholds and beside them, too."""
    model = MODELS[name].fit(X, Y)
    node = described(model)
    edges = node["threshold"][np.isfinite(node["threshold"])][:60]
    at = np.tile(edges[:, None], 3)
    rows = np.vstack([X[:60], 1.7 * X[:40], at, np.nextafter(at, np.inf), np.nextafter(at, -np.inf)])
    answer = regressor(node)
    many, one = answer(rows)[0], np.vstack([answer(row[None])[0] for row in rows])
    np.testing.assert_array_equal(one, many)
    np.testing.assert_allclose(one, model.predict(rows), rtol=1e-12, atol=1e-12)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n_trees=st.integers(1, 4), n_splits=st.integers(0, 150))
def test_the_leaf_by_masks_is_the_leaf_that_is_walked_to(seed: int, n_trees: int, n_splits: int) -> None:
    rng = np.random.default_rng(seed)
    node = made_up(rng, n_trees, n_splits)
    find = leaf_finder(node)
    assert find is not None
    for row in rng.integers(-3, 4, (5, 2)).astype(float):
        np.testing.assert_array_equal(find(row), walked(node, row))


def test_leaves_are_numbered_from_the_left() -> None:
    node = made_up(np.random.default_rng(0), 1, 20)
    is_leaf, tree, first, count = in_order(node)
    assert not tree.any()
    np.testing.assert_array_equal(np.sort(first[is_leaf]), np.arange(21))
    assert count[0] == 21
    inner = np.flatnonzero(~is_leaf)
    np.testing.assert_array_equal(first[node["right"][inner]], first[inner] + count[node["left"][inner]])


def test_trees_whose_masks_are_too_many_are_walked(monkeypatch: pytest.MonkeyPatch) -> None:
    node = described(MODELS["forest of deep trees"].fit(X, Y))
    by_masks = regressor(node)(X[:1])[0]
    monkeypatch.setattr(leaves, "MOST_BYTES", 1000)
    assert leaf_finder(node) is None
    np.testing.assert_array_equal(regressor(node)(X[:1])[0], by_masks)


def made_up(rng: np.random.Generator, n_trees: int, n_splits: int) -> Node:
    """Trees of two features, whose leaves are split one after the other, at whole numbers."""
    size = 2 * n_splits + 1
    left, right = (np.arange(n_trees * size) for _ in range(2))
    for root in range(0, n_trees * size, size):
        open_leaves = [root]
        for split in range(n_splits):
            parent = open_leaves.pop(int(rng.integers(len(open_leaves))))
            left[parent], right[parent] = root + 2 * split + 1, root + 2 * split + 2
            open_leaves += [left[parent], right[parent]]
    is_leaf = left == np.arange(len(left))
    return {
        "roots": np.arange(0, n_trees * size, size),
        "left": left,
        "right": right,
        "feature": np.where(is_leaf, 0, rng.integers(0, 2, len(left))),
        "threshold": np.where(is_leaf, np.inf, rng.integers(-3, 4, len(left))),
        "leaf": np.where(is_leaf, np.cumsum(is_leaf) - 1, 0),
    }


def walked(node: Node, row: Array) -> list[int]:
    """The leaf of each tree, step by step."""
    found = []
    for place in node["roots"]:
        while node["left"][place] != place:
            goes_left = row[node["feature"][place]] <= node["threshold"][place]
            place = node["left" if goes_left else "right"][place]
        found.append(int(node["leaf"][place]))
    return found
