"""What fitted trees and their ensembles are in plain numbers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array, Samples
from softkin.models.plain.kernels import Node

Whole = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Tree:
    """Nodes of a tree, the root first: children (n_nodes,), -1 of a leaf; what goes left is at most the threshold;
    values (n_nodes, n_columns).
    """

    left: Whole
    right: Whole
    feature: Whole
    threshold: Array
    values: Array


def of_forest(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of a random forest of all targets: the mean of its trees, which compare features of 32 bits."""
    trees = [_of_scikit_learn(one.tree_, 1.0) for one in estimators[0].estimators_]
    constant = np.zeros(trees[0].values.shape[1])
    return _node(trees, (len(trees),), constant, single=True) | {"has_spread": known is not None}


def of_gradient_boosting(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of a gradient boosting for each target."""
    trees = [_of_scikit_learn(one.tree_, each.learning_rate) for each in estimators for (one,) in each.estimators_]
    constant = np.array([each.init_.constant_.item() for each in estimators])
    return _node(trees, (len(estimators), -1), constant, single=True)


def of_histogram_boosting(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of a histogram boosting for each target."""
    trees = [_of_histogram(one.nodes) for each in estimators for (one,) in each._predictors]
    constant = np.array([each._baseline_prediction.item() for each in estimators])
    return _node(trees, (len(estimators), -1), constant, single=False)


def of_xgboost(estimators: Sequence[Any], known: Samples | None) -> Node:
    """Of XGBoost: a tree for each target and round, added in 32 bits in this order."""
    booster = estimators[0].get_booster()
    (saved,) = (part for part in json.loads(bytes(booster.save_raw("json"))).values() if "gradient_booster" in part)
    (first,) = (part["base_score"] for part in saved.values() if "base_score" in part)
    model, constant = saved["gradient_booster"]["model"], np.ravel(json.loads(first)).astype(np.float32)
    order = np.argsort(model["tree_info"], kind="stable")
    trees = [_of_xgboost(model["trees"][place]) for place in order]
    return _node(trees, (len(constant), -1), constant.astype(np.float64), single=True) | {"single_sums": True}


def of_one_tree(tree: Any, values: Array) -> Node:
    """Of one tree of scikit-learn, with other values (n_nodes, n_columns) in its nodes."""
    one = Tree(tree.children_left, tree.children_right, tree.feature, tree.threshold, values)
    return _node([one], (1,), np.zeros(values.shape[1]), single=True)


def _of_scikit_learn(tree: Any, rate: float) -> Tree:
    values = rate * tree.value[:, :, 0]
    return Tree(tree.children_left, tree.children_right, tree.feature, tree.threshold, values)


def _of_histogram(nodes: Any) -> Tree:
    is_leaf = nodes["is_leaf"].astype(bool)
    left, right = (np.where(is_leaf, -1, nodes[side].astype(np.int64)) for side in ("left", "right"))
    return Tree(left, right, nodes["feature_idx"].astype(np.int64), nodes["num_threshold"], nodes["value"][:, None])


def _of_xgboost(tree: Any) -> Tree:
    """XGBoost goes left where a feature is below its threshold: at most the number of 32 bits before it."""
    conditions = np.array(tree["split_conditions"], dtype=np.float32)
    before = np.nextafter(conditions, np.float32(-np.inf)).astype(np.float64)
    left, right, feature = (
        np.array(tree[name], dtype=np.int64) for name in ("left_children", "right_children", "split_indices")
    )
    return Tree(left, right, feature, before, conditions.astype(np.float64)[:, None])


def _node(trees: Sequence[Tree], shape: tuple[int, ...], constant: Array, *, single: bool) -> Node:
    """The node of trees, whose roots have a shape; a leaf leads to itself."""
    starts = np.cumsum([0, *(len(tree.left) for tree in trees)])
    left, right = (
        np.concatenate([getattr(tree, side) + start for tree, start in zip(trees, starts[:-1], strict=True)])
        for side in ("left", "right")
    )
    is_leaf = np.concatenate([tree.left < 0 for tree in trees])
    places = np.arange(len(left))
    left, right = np.where(is_leaf, places, left), np.where(is_leaf, places, right)
    feature = np.where(is_leaf, 0, np.concatenate([tree.feature for tree in trees]))
    threshold = np.where(is_leaf, np.inf, np.concatenate([tree.threshold for tree in trees]))
    return {
        "kind": "trees",
        "roots": starts[:-1].reshape(shape),
        "feature": feature,
        "threshold": threshold,
        "left": left,
        "right": right,
        "depth": _depth(left, right, starts[:-1]),
        "leaf": np.where(is_leaf, np.cumsum(is_leaf) - 1, 0),
        "values": np.concatenate([tree.values for tree in trees])[is_leaf],
        "constant": constant,
        "single": single,
        "single_sums": False,
        "has_spread": False,
    }


def _depth(left: Whole, right: Whole, roots: Whole) -> int:
    """Steps from the roots to the farthest leaf."""
    depth, reached = 0, roots
    while len(reached := reached[left[reached] != reached]):
        depth, reached = depth + 1, np.concatenate([left[reached], right[reached]])
    return depth
