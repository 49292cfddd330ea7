from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.export.onnx_text import Graph
from tests.asked_onnx import needs_onnx, value_of

X = np.array([[0.3, -2.0], [1e-9, 5.0]])


def test_the_same_numbers_are_there_once() -> None:
    graph = Graph()
    assert graph.constant(1.0) == graph.constant(np.float64(1.0))
    assert len({graph.constant(1), graph.constant(1.0), graph.constant([1.0]), graph.constant(2.0)}) == 4


@pytest.mark.parametrize(
    ("kind", "value", "kinds"),
    [
        ("Mul", 1 + 1e-9, ["Mul", "Sum"]),
        ("Div", 1 - 1e-9, ["Mul", "Sum"]),
        ("Add", 1e-9, ["Sum"]),
        ("Sub", 1e-9, ["Sum"]),
        ("Mul", 1.0, ["Mul"]),
        ("Mul", 2.0, ["Mul"]),
        ("Add", 0.0, ["Add"]),
        ("Add", np.array([1e-9, 1e-9]), ["Add"]),
    ],
)
def test_numbers_that_are_nearly_neutral_are_written_otherwise(kind: str, value: object, kinds: list[str]) -> None:
    graph = Graph()
    graph.op(kind, "commands", value)
    assert [node[0] for node in graph.nodes] == kinds


@needs_onnx
@pytest.mark.parametrize("kind", ["Mul", "Div", "Add", "Sub"])
@pytest.mark.parametrize("off", [1e-9, -3e-8, 1e-12, 1e-4])
def test_they_count_in_onnxruntime(kind: str, off: float) -> None:
    number, graph = off + (kind in ("Mul", "Div")), Graph()
    wanted = {"Mul": X * number, "Div": X / number, "Add": X + number, "Sub": X - number}[kind]
    found = value_of(graph, graph.op(kind, "commands", number), X, 2)
    np.testing.assert_allclose(found, wanted, rtol=3e-16, atol=0)


@needs_onnx
def test_squared_distances() -> None:
    graph, points = Graph(), np.array([[0.0, 1.0], [2.0, -1.0], [0.3, -2.0]])
    wanted = ((X[:, None] - points) ** 2).sum(axis=2)
    np.testing.assert_allclose(value_of(graph, graph.squares("commands", points), X, 3), wanted, rtol=1e-15)
