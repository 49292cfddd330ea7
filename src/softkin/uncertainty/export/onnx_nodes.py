"""Registry of how nodes of plain numbers are written as graphs of ONNX: from features to targets, in 64 bits."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from typing import Any

import numpy as np

from softkin.core.errors import ConfigError
from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.onnx_text import Graph


def onnx_targets(graph: Graph, node: Node, x: str) -> str:
    """The value of the targets (n_rows, n_targets) of a node at features x (n_rows, n_features).

    Raises:
        ConfigError: there is no writer for its kind.
    """
    if node["kind"] not in ONNX_WRITERS:
        raise ConfigError(
            f"a model of kind '{node['kind']}' cannot be written as ONNX with the same answers",
            where="export to ONNX",
            fix="export it as a Python file or a C header",
        )
    return ONNX_WRITERS[node["kind"]](graph, node, x)


def _standardised(graph: Graph, node: Node, x: str) -> str:
    z = graph.op("Div", graph.op("Sub", x, node["mean"]), node["scale"])
    return onnx_targets(graph, node["inner"], z)


def _polynomial(graph: Graph, node: Node, x: str) -> str:
    one = graph.op("Add", graph.op("Mul", graph.columns(x, [0]), 0.0), 1.0)
    extended = graph.op("Concat", x, one, axis=1)
    factors = [graph.columns(extended, column) for column in np.asarray(node["factors"]).T]
    terms = reduce(lambda a, b: graph.op("Mul", a, b), factors)
    terms = graph.op("Div", graph.op("Sub", terms, node["mean"]), node["scale"])
    return graph.op("Add", graph.op("MatMul", terms, node["weights"]), node["constant"])


def _kernel(graph: Graph, node: Node, x: str) -> str:
    kernel = graph.sum([_term(graph, term, node["points"], x) for term in node["terms"]])
    summed = graph.op("MatMul", kernel, node["weights"])
    if "expansion" in node:
        parts = [_powers(graph, part, x) for part in node["expansion"]]
        holds = reduce(lambda a, b: graph.op("And", a, b), [near for _, near in parts])
        summed = graph.op("Where", holds, graph.sum([targets for targets, _ in parts]), summed)
    return graph.op("Add", summed, node["constant"])


def _term(graph: Graph, term: Node, points: Any, x: str) -> str:
    """A term (n_rows, n_points) of a kernel."""
    if term["shape"] == "product":
        inner = graph.op("Add", graph.op("Mul", graph.op("MatMul", x, points.T), term["rate"]), term["offset"])
        value = reduce(lambda a, b: graph.op("Mul", a, b), [inner] * int(term["power"]))
        return graph.op("Mul", value, term["constant"])
    squares = graph.squares(graph.op("Div", x, term["lengths"]), points / term["lengths"])
    return graph.op("Mul", SHAPES[term["shape"]](graph, term, squares), term["constant"])


def _matern32(graph: Graph, _: Node, squares: str) -> str:
    far = graph.op("Mul", graph.op("Sqrt", squares), np.sqrt(3.0))
    return graph.op("Mul", graph.op("Add", far, 1.0), graph.op("Exp", graph.op("Neg", far)))


def _matern52(graph: Graph, _: Node, squares: str) -> str:
    far = graph.op("Mul", graph.op("Sqrt", squares), np.sqrt(5.0))
    square = graph.op("Div", graph.op("Mul", far, far), 3.0)
    return graph.op("Mul", graph.op("Add", graph.op("Add", far, 1.0), square), graph.op("Exp", graph.op("Neg", far)))


def _rational(graph: Graph, term: Node, squares: str) -> str:
    base = graph.op("Add", graph.op("Div", squares, term["rate"]), 1.0)
    return graph.op("Pow", base, -float(term["power"]))


def _powers(graph: Graph, part: Node, x: str) -> tuple[str, str]:
    """The targets of a part of an expansion, and in which rows (n_rows, 1) they hold."""
    z = graph.op("Div", x, part["lengths"])
    squares = graph.row_sums(graph.op("Mul", z, z))
    near = graph.op("LessOrEqual", squares, part["reach"] ** 2)
    z = graph.op("Where", near, z, 0.0)
    products = []
    for place, powers in enumerate(part["powers"].T):
        column = graph.columns(z, [place])
        table = [graph.op("Add", graph.op("Mul", column, 0.0), 1.0)]
        for _ in range(int(part["powers"].max())):
            table.append(graph.op("Mul", table[-1], column))
        products.append(graph.columns(graph.op("Concat", *table, axis=1), powers))
    weighed = graph.op("MatMul", reduce(lambda a, b: graph.op("Mul", a, b), products), part["weights"])
    return graph.op("Mul", weighed, graph.op("Exp", graph.op("Mul", squares, -part["rate"]))), near


def _network(graph: Graph, node: Node, x: str) -> str:
    last = len(node["weights"]) - 1
    for place, (weights, biases) in enumerate(zip(node["weights"], node["biases"], strict=True)):
        x = graph.op("Add", graph.op("MatMul", x, weights), biases)
        x = x if place == last else ACTIVATIONS[node["activation"]](graph, x)
    return x


def _mean(graph: Graph, node: Node, x: str) -> str:
    parts = zip(node["members"], node["shares"], strict=True)
    return graph.sum([graph.op("Mul", onnx_targets(graph, member, x), float(share)) for member, share in parts])


def _detrended(graph: Graph, node: Node, x: str) -> str:
    rest = graph.op("Mul", onnx_targets(graph, node["rest"], x), node["scale"])
    return graph.op("Add", onnx_targets(graph, node["trend"], x), rest)


def one_tree(graph: Graph, node: Node, x: str) -> str:
    """The values (n_rows, n_columns) of the leaves that one tree leads to, whose features have 32 bits.

    All its comparisons are made, and the leaf all of whose comparisons say so is the one.
    """
    left, right, leaf = node["left"], node["right"], node["leaf"]
    inner = np.flatnonzero(left != np.arange(len(left)))
    row, ways = {int(place): i for i, place in enumerate(inner)}, np.zeros((len(inner), len(node["values"])))
    stack: list[tuple[int, list[tuple[int, float]]]] = [(int(node["roots"][0]), [])]
    while stack:
        place, taken = stack.pop()
        if place not in row:
            for at, way in taken:
                ways[at, leaf[place]] = way
            continue
        stack += [(int(left[place]), [*taken, (row[place], 1.0)]), (int(right[place]), [*taken, (row[place], -1.0)])]
    single = graph.op("Cast", graph.op("Cast", x, to=1), to=11)
    goes_left = graph.op("LessOrEqual", graph.columns(single, node["feature"][inner]), node["threshold"][inner])
    signs = graph.op("Sub", graph.op("Mul", graph.op("Cast", goes_left, to=11), 2.0), 1.0)
    agree = graph.op("GreaterOrEqual", graph.op("MatMul", signs, ways), np.abs(ways).sum(axis=0))
    return graph.op("Add", graph.op("MatMul", graph.op("Cast", agree, to=11), node["values"]), node["constant"])


SHAPES: dict[str, Callable[[Graph, Node, str], str]] = {
    "exponential": lambda graph, term, squares: graph.op("Exp", graph.op("Mul", squares, -float(term["rate"]))),
    "matern32": _matern32,
    "matern52": _matern52,
    "rational": _rational,
}
ACTIVATIONS: dict[str, Callable[[Graph, str], str]] = {
    "tanh": lambda graph, x: graph.op("Tanh", x),
    "logistic": lambda graph, x: graph.op("Mul", graph.op("Add", graph.op("Tanh", graph.op("Mul", x, 0.5)), 1.0), 0.5),
    "relu": lambda graph, x: graph.op("Max", x, 0.0),
    "identity": lambda _, x: x,
}
#: Trees are left out: XGBoost adds in 32 bits in an order, and a forest's comparisons would be a matrix of all leaves.
ONNX_WRITERS: dict[str, Callable[[Graph, Node, str], str]] = {
    "standardised": _standardised,
    "polynomial": _polynomial,
    "kernel": _kernel,
    "network": _network,
    "mean": _mean,
    "detrended": _detrended,
}
