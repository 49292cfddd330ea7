from __future__ import annotations

import numpy as np
import pytest

from softkin.models.plain.spaces import SPACES, space
from softkin.uncertainty.export.onnx_robot import SPACE_WRITERS, onnx_outside, onnx_positions
from softkin.uncertainty.export.onnx_text import Graph
from tests.asked_onnx import needs_onnx, value_of
from tests.exported_robots import NEW, small


def test_all_target_spaces_are_written() -> None:
    assert set(SPACE_WRITERS) == set(SPACES)


@needs_onnx
@pytest.mark.parametrize("name", ["lr", "lasso"])
def test_targets_go_to_positions(name: str) -> None:
    node, graph = small(name)._prepared.numbers["members"][0]["space"], Graph()
    targets = np.random.default_rng(0).normal(size=(20, 3))
    targets[0] = 0.0
    found = value_of(graph, onnx_positions(graph, node, "commands", 6), targets, 6)
    np.testing.assert_allclose(found, space(node).positions(targets), rtol=0, atol=1e-12)


@needs_onnx
def test_norms_and_what_lies_outside() -> None:
    robot, graph = small("lr"), Graph()
    outside, norms = onnx_outside(graph, robot._prepared.numbers, "commands")
    np.testing.assert_allclose(
        value_of(graph, norms, NEW, 1)[:, 0], robot._prepared.plain.norms(NEW), rtol=1e-14, atol=0
    )
    flags = value_of(graph, graph.op("Cast", outside, to=11), NEW, 1)[:, 0]
    np.testing.assert_array_equal(flags.astype(bool), robot.is_outside(NEW))
