"""An exported graph of ONNX, asked by onnxruntime on one thread."""

from __future__ import annotations

import importlib
import importlib.util
from typing import Any

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.uncertainty.export.onnx_text import Graph

needs_onnx = pytest.mark.skipif(
    importlib.util.find_spec("onnx") is None or importlib.util.find_spec("onnxruntime") is None,
    reason="the extra 'onnx' is not installed: pip install '.[onnx]'",
)


def answers(content: bytes, commands: Array) -> dict[str, Any]:
    """All outputs at commands (n_rows, n_commands), by their names."""
    runtime = importlib.import_module("onnxruntime")
    options = runtime.SessionOptions()
    options.intra_op_num_threads = 1
    session = runtime.InferenceSession(content, options, providers=["CPUExecutionProvider"])
    names = [one.name for one in session.get_outputs()]
    return dict(zip(names, session.run(None, {"commands": np.ascontiguousarray(commands)}), strict=True))


def value_of(graph: Graph, value: str, x: Array, n_columns: int) -> Array:
    """A value (n_rows, n_columns) of a graph at x."""
    content = graph.model({"value": (value, "double", ["n_rows", n_columns])}, x.shape[1], {})
    return np.asarray(answers(content, x)["value"])
