from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from sklearn.tree import DecisionTreeRegressor

from softkin.core.errors import ConfigError
from softkin.models.plain.describe_trees import of_one_tree
from softkin.models.plain.evaluate import KINDS, regressor
from softkin.models.plain.kernels import SHAPES as ALL_SHAPES
from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.onnx_nodes import ACTIVATIONS, ONNX_WRITERS, SHAPES, one_tree, onnx_targets
from softkin.uncertainty.export.onnx_text import Graph
from tests.asked_onnx import needs_onnx, value_of

RNG = np.random.default_rng(0)
X, POINTS = RNG.normal(size=(40, 2)), RNG.normal(size=(12, 2))
LENGTHS = np.array([1.5, 0.7])
TERMS: dict[str, Node] = {
    "exponential": {"lengths": LENGTHS, "rate": 0.5},
    "matern32": {"lengths": LENGTHS},
    "matern52": {"lengths": LENGTHS},
    "rational": {"lengths": np.ones(2), "rate": 1.7, "power": 0.8},
    "product": {"rate": 0.9, "offset": 0.4, "power": 3},
}
POLYNOMIAL: Node = {
    "kind": "polynomial",
    "n_features": 2,
    "factors": np.array([[0, 2, 2], [1, 1, 2], [0, 0, 1]]),
    "mean": np.array([0.1, 0.2, 0.3]),
    "scale": np.array([1.0, 2.0, 3.0]),
    "weights": RNG.normal(size=(3, 2)),
    "constant": np.array([1e-9, 4.0]),
}


def kernel(shape: str) -> Node:
    term = {"shape": shape, "constant": 1.3} | TERMS[shape]
    return {"kind": "kernel", "points": POINTS, "terms": [term], "weights": RNG.normal(size=(12, 2))} | {
        "constant": np.zeros(2)
    }


def network(activation: str) -> Node:
    weights, biases = [RNG.normal(size=(2, 5)), RNG.normal(size=(5, 2))], [RNG.normal(size=5), RNG.normal(size=2)]
    return {"kind": "network", "weights": weights, "biases": biases, "activation": activation}


def expanded() -> Node:
    powers = np.array([[0, 0], [2, 1]])
    part = {"lengths": LENGTHS, "rate": 0.5, "reach": 1.2, "powers": powers, "weights": RNG.normal(size=(2, 2))}
    return kernel("exponential") | {"expansion": [part]}


NODES: dict[str, Any] = {shape: kernel(shape) for shape in TERMS}
NODES |= {name: network(name) for name in ACTIVATIONS}
NODES |= {
    "polynomial": POLYNOMIAL,
    "expanded": expanded(),
    "standardised": {"kind": "standardised", "mean": LENGTHS, "scale": LENGTHS, "inner": POLYNOMIAL},
    "mean": {"kind": "mean", "members": [POLYNOMIAL, network("tanh")], "shares": np.array([0.3, 0.7])},
    "detrended": {"kind": "detrended", "trend": POLYNOMIAL, "rest": kernel("matern32"), "scale": np.array([2.0])},
}


def test_all_kinds_but_trees_and_all_shapes_are_written() -> None:
    assert set(KINDS) - set(ONNX_WRITERS) == {"trees"}
    assert {*SHAPES, "product"} == set(ALL_SHAPES) == set(TERMS)
    with pytest.raises(ConfigError, match="a model of kind 'trees' cannot be written as ONNX with the same answers"):
        onnx_targets(Graph(), {"kind": "trees"}, "commands")


@needs_onnx
@pytest.mark.parametrize("name", NODES)
def test_a_node_answers_as_its_numbers(name: str) -> None:
    graph = Graph()
    found = value_of(graph, onnx_targets(graph, NODES[name], "commands"), X, 2)
    np.testing.assert_allclose(found, regressor(NODES[name])(X)[0], rtol=1e-13, atol=1e-13)


@needs_onnx
def test_one_tree_leads_to_its_leaves() -> None:
    fitted = DecisionTreeRegressor(random_state=0).fit(X, X[:, 0] * X[:, 1]).tree_
    node, graph = of_one_tree(fitted, RNG.normal(size=(fitted.node_count, 3))), Graph()
    # On the thresholds, and between two numbers of 32 bits.
    rows = np.vstack([X, np.full((1, 2), fitted.threshold[0]), np.full((1, 2), fitted.threshold[0] * (1 + 1e-9))])
    found = value_of(graph, one_tree(graph, node, "commands"), rows, 3)
    np.testing.assert_allclose(found, regressor(node)(rows)[0], rtol=1e-15)
