"""A calibrated model as ONNX in double precision: commands in; positions, bounds at stored levels, `outside` out."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from typing import Any

import numpy as np

from softkin import __version__
from softkin.core.errors import ConfigError
from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.c_header import MOST_NUMBERS
from softkin.uncertainty.export.numbers import LEVELS, exported_numbers
from softkin.uncertainty.export.onnx_nodes import onnx_targets
from softkin.uncertainty.export.onnx_robot import (
    onnx_bounds,
    onnx_difficulty,
    onnx_failures,
    onnx_outside,
    onnx_positions,
)
from softkin.uncertainty.export.onnx_text import ROWS, Graph, Output


def onnx_file(robot: Any, confidence_levels: Sequence[float] = LEVELS) -> bytes:
    """The file: one input `commands` (n_rows, n_commands); outputs `position` (n_rows, n_coordinates), `lower` and
    `upper` (n_levels, n_rows, n_coordinates) in mm, `outside` (n_rows, 1); where failures are known,
    `failure_probability` (n_rows, 1) and `may_fail` (n_levels, n_rows, 1).

    Raises:
        ConfigError: as of `exported_numbers`; onnx is not installed; the model has a part that ONNX does not answer
            with the same numbers.
    """
    numbers = exported_numbers(robot, confidence_levels, most=MOST_NUMBERS)
    other = "export it as a Python file or a C header"
    if numbers["memory"] is not None:
        raise _refused(robot, "it remembers earlier commands, and a graph of ONNX has no state", other)
    if numbers["difficulty"]["kind"] == "spread":
        raise _refused(robot, "its intervals are as wide as a spread, which ONNX has no operator to solve for", other)
    graph, n_coordinates = Graph(), len(numbers["coordinates"])
    parts = [
        graph.op(
            "Mul",
            onnx_positions(graph, member["space"], onnx_targets(graph, member["regressor"], "commands"), n_coordinates),
            float(share),
        )
        for share, member in zip(numbers["shares"], numbers["members"], strict=True)
    ]
    position = graph.op("Add", graph.sum(parts), np.asarray(numbers["zero"], dtype=np.float64))
    outside, norms = onnx_outside(graph, numbers, "commands")
    difficulty = onnx_difficulty(graph, numbers, "commands")
    values = {"position": position, "difficulty": difficulty, "outside": outside, "norms": norms}
    bounds = [onnx_bounds(graph, numbers, place, values) for place in range(len(numbers["levels"]))]
    levels = [len(numbers["levels"]), ROWS]
    outputs: dict[str, Output] = {
        "position": (position, "double", [ROWS, n_coordinates]),
        "outside": (outside, "bool", [ROWS, 1]),
    }
    if numbers["failures"] is not None:
        probability, flags, bounds = onnx_failures(graph, numbers["failures"], "commands", bounds)
        outputs["failure_probability"] = (probability, "double", [ROWS, 1])
        outputs["may_fail"] = (_stacked(graph, flags), "bool", [*levels, 1])
    for side, name in enumerate(("lower", "upper")):
        outputs[name] = (_stacked(graph, [each[side] for each in bounds]), "double", [*levels, n_coordinates])
    if importlib.util.find_spec("onnx") is None:
        raise _refused(robot, "onnx is not installed", "install it: .venv/bin/pip install '.[onnx]'; or export others")
    return graph.model(outputs, numbers["n_commands"], _about(numbers))


def _stacked(graph: Graph, levels: list[str]) -> str:
    """Values of each level, as one whose first axis they are."""
    return graph.op("Concat", *(graph.op("Unsqueeze", one, np.array([0])) for one in levels), axis=0)


def _about(numbers: Node) -> dict[str, str]:
    shown = {key: ", ".join(map(str, numbers[key])) for key in ("commands", "coordinates", "levels")}
    texts = {key: str(numbers[key]) for key in ("dataset", "model", "unit", "known_to")}
    return shown | texts | {"softkin": __version__}


def _refused(robot: Any, what: str, fix: str) -> ConfigError:
    return ConfigError(f"{what}: it cannot be written as ONNX", where=robot.dataset, fix=fix)
