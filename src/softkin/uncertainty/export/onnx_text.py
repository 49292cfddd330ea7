"""A graph of ONNX in double precision, put together node by node."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

#: Version of the operators: the first by which all that are used here have 64 bits.
OPSET, IR_VERSION = 18, 9

#: onnxruntime leaves out sums with one number below about 1e-8, and products with one as near to 1, as if they were 0
#: and 1; numbers nearer than this are written otherwise.
NEARLY = 1e-3
#: A value, its kind ("double" or "bool") and its shape, in which rows have the name `ROWS`.
Output = tuple[str, str, list[Any]]
ROWS = "n_rows"


class Graph:
    """Nodes and constants; values have names, and rows of commands come first in the shape of all."""

    def __init__(self) -> None:
        self.nodes: list[tuple[str, list[str], str, dict[str, Any]]] = []
        self.constants: dict[tuple[str, tuple[int, ...], bytes], tuple[str, Any]] = {}

    def constant(self, values: Any) -> str:
        """The name of numbers: 64 bits, or whole ones; the same ones have one name."""
        array = np.asarray(values)
        array = np.array(array, dtype=np.int64 if array.dtype.kind in "iu" else np.float64, order="C")
        key = (array.dtype.str, array.shape, array.tobytes())
        return self.constants.setdefault(key, (f"c{len(self.constants)}", array))[0]

    def op(self, kind: str, *inputs: Any, **attributes: Any) -> str:
        """The name of the result of an operator of values, by their names, and numbers."""
        if kind in ("Add", "Sub", "Mul", "Div") and not isinstance(inputs[1], str) and np.size(inputs[1]) == 1:
            value, neutral = float(np.ravel(inputs[1])[0]), float(kind in ("Mul", "Div"))
            if 0.0 < abs(value - neutral) < NEARLY:
                return self._step(kind, inputs[0], np.asarray(inputs[1], dtype=np.float64))
        names = [one if isinstance(one, str) else self.constant(one) for one in inputs]
        outputs = 2 if kind == "TopK" else 1
        name = f"v{len(self.nodes)}"
        self.nodes.append((kind, names, name, attributes | {"softkin_outputs": outputs}))
        return name

    def _step(self, kind: str, x: str, value: Any) -> str:
        """A sum or product with a number that is nearly 0 or 1, of operators that onnxruntime does not leave out."""
        if kind in ("Add", "Sub"):
            return self.op("Sum", x, value if kind == "Add" else -value)
        more = value - 1.0 if kind == "Mul" else (1.0 - value) / value
        return self.op("Sum", x, self.op("Mul", x, more))

    def columns(self, x: str, places: Any) -> str:
        """Columns of a value, in this order."""
        return self.op("Gather", x, np.asarray(places, dtype=np.int64), axis=1)

    def sum(self, parts: list[str]) -> str:
        """The sum of values."""
        total, *others = parts
        for one in others:
            total = self.op("Add", total, one)
        return total

    def row_sums(self, x: str) -> str:
        """Sums (n_rows, 1) over the columns of a value."""
        return self.op("ReduceSum", x, np.array([1]), keepdims=1)

    def squares(self, x: str, points: Any) -> str:
        """Squared distances (n_rows, n_points) of rows to points (n_points, n_columns)."""
        apart = [self.op("Sub", self.columns(x, [place]), column[None]) for place, column in enumerate(points.T)]
        return self.sum([self.op("Mul", one, one) for one in apart])

    def model(self, outputs: dict[str, Output], n_inputs: int, about: dict[str, str]) -> bytes:
        """The file of the graph, whose one input is `commands`.

        Parameters:
            outputs: by their names.
            n_inputs: commands of a row.
            about: what is written beside the graph.
        """
        onnx = importlib.import_module("onnx")
        helper, kinds = onnx.helper, {"double": onnx.TensorProto.DOUBLE, "bool": onnx.TensorProto.BOOL}
        nodes = []
        for kind, names, name, attributes in self.nodes:
            own = {key: value for key, value in attributes.items() if key != "softkin_outputs"}
            several = [name, f"{name}_places"][: attributes["softkin_outputs"]]
            nodes.append(helper.make_node(kind, names, several, **own))
        nodes += [helper.make_node("Identity", [value], [name]) for name, (value, _, _) in outputs.items()]
        graph = helper.make_graph(
            nodes,
            "softkin",
            [helper.make_tensor_value_info("commands", kinds["double"], [ROWS, n_inputs])],
            [helper.make_tensor_value_info(name, kinds[kind], shape) for name, (_, kind, shape) in outputs.items()],
            [onnx.numpy_helper.from_array(array, name) for name, array in self.constants.values()],
        )
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=IR_VERSION)
        helper.set_model_props(model, about)
        onnx.checker.check_model(model)
        return bytes(model.SerializeToString())
