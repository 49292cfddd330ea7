"""What of a robot is written as ONNX around its regressor: target space, what lies outside, bounds."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce

import numpy as np

from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.onnx_nodes import one_tree
from softkin.uncertainty.export.onnx_text import Graph


def onnx_positions(graph: Graph, node: Node, targets: str, n_coordinates: int) -> str:
    """The value of positions (n_rows, n_coordinates) in mm of targets."""
    return SPACE_WRITERS[node["space"]](graph, node, targets, n_coordinates)


def _scaled(graph: Graph, node: Node, targets: str, n_coordinates: int) -> str:
    placed = np.zeros((len(node["kept"]), n_coordinates))
    placed[np.arange(len(placed)), node["kept"]] = 1.0
    rest = np.where(placed.any(axis=0), 0.0, np.ravel(node["constants"]))
    found = graph.op("Add", graph.op("Mul", targets, node["scale"]), node["mean"])
    return graph.op("Add", graph.op("MatMul", found, placed), rest)


def _arcs(graph: Graph, node: Node, targets: str, n_coordinates: int) -> str:
    n_moving, n_arcs, free = len(node["moving"]), node["n_arcs"], np.ones(n_coordinates)
    free[node["near_constant"]] = 0.0
    arcs = _scaled(graph, node["arcs"], graph.columns(targets, np.arange(n_arcs)), 3 * n_moving)
    rest, parts = np.array(node["constants"], dtype=np.float64), []
    rest[node["moving"]] = node["origin"]
    for place, marker in enumerate(node["moving"]):
        turned = np.zeros((3, n_coordinates))
        turned[:, 3 * marker : 3 * marker + 3] = node["axes"].T
        parts.append(graph.op("MatMul", _arc_end(graph, arcs, 3 * place), turned * free))
    if "others" in node:
        n = len(node["near_constant"])
        places = np.arange(n_arcs, n_arcs + n)
        others, placed = _scaled(graph, node["others"], graph.columns(targets, places), n), np.zeros((n, n_coordinates))
        placed[np.arange(n), node["near_constant"]] = 1.0
        parts.append(graph.op("MatMul", others, placed))
        return graph.op("Add", graph.sum(parts), rest.ravel() * free)
    return graph.op("Add", graph.sum(parts), rest.ravel())


def _arc_end(graph: Graph, arcs: str, first: int) -> str:
    """The end (n_rows, 3) of the arc whose coordinates begin at column `first`; as `from_arcs`."""
    x, y, length = (graph.columns(arcs, [first + place]) for place in range(3))
    bending = graph.op("Sqrt", graph.op("Add", graph.op("Mul", x, x), graph.op("Mul", y, y)))
    half = _sinc(graph, graph.op("Mul", bending, 0.5))
    sideways = graph.op("Mul", graph.op("Mul", length, 0.5), graph.op("Mul", half, half))
    up = graph.op("Mul", length, _sinc(graph, bending))
    return graph.op("Concat", graph.op("Mul", sideways, x), graph.op("Mul", sideways, y), up, axis=1)


def _sinc(graph: Graph, angle: str) -> str:
    is_zero = graph.op("Equal", angle, 0.0)
    safe = graph.op("Where", is_zero, 1.0, angle)
    return graph.op("Where", is_zero, 1.0, graph.op("Div", graph.op("Sin", safe), safe))


def onnx_outside(graph: Graph, numbers: Node, commands: str) -> tuple[str, str]:
    """Which rows (n_rows, 1) lie outside, and their norms (n_rows, 1)."""
    places = numbers["surroundings"]
    z = graph.op("Div", graph.op("Sub", commands, places["mean"]), places["scale"])
    near = graph.op("Sqrt", graph.op("ReduceMin", graph.squares(z, places["points"]), np.array([1]), keepdims=1))
    apart = graph.op("Sub", graph.columns(commands, places["varies"]), places["centre"])
    apart = graph.op("Div", apart, places["norm_scale"])
    norms = graph.op("Sqrt", graph.row_sums(graph.op("Mul", apart, apart)))
    far = graph.op("Greater", near, float(places["gap"]))
    return graph.op("Or", far, graph.op("Greater", norms, float(places["radius"]))), norms


def onnx_difficulty(graph: Graph, numbers: Node, commands: str) -> str | None:
    """What sides are multiplied by, (n_rows, n_coordinates) or (n_rows, 1); None: by 1. Spreads are not written."""
    node = numbers["difficulty"]
    if node["kind"] == "none":
        return None
    z = graph.op("Div", graph.op("Sub", commands, node["mean"]), node["scale"])
    found = _by_distance(graph, node, z) if node["kind"] == "distance" else _by_errors(graph, node, z)
    return graph.op("Max", found, float(node["floor"]))


def _by_distance(graph: Graph, node: Node, z: str) -> str:
    k = int(node["neighbours"])
    best = graph.op("TopK", graph.squares(z, node["points"]), np.array([k]), axis=1, largest=0, sorted=1)
    near = graph.op("Div", graph.row_sums(graph.op("Sqrt", best)), float(k))
    apart = graph.op("Sub", z, graph.op("Min", graph.op("Max", z, node["low"]), node["high"]))
    beyond = graph.op("Sqrt", graph.row_sums(graph.op("Mul", apart, apart)))
    emptiest = float(node["emptiest"])
    near = graph.op(
        "Where",
        graph.op("Greater", beyond, 0.0),
        graph.op("Add", beyond, emptiest),
        graph.op("Min", near, emptiest),
    )
    return graph.op("Add", graph.op("Div", near, float(node["unit"])), float(node["least"]))


def _by_errors(graph: Graph, node: Node, z: str) -> str:
    """As `near_errors`; the last column is that of constant coordinates."""
    one = graph.op("Add", graph.op("Mul", graph.columns(z, [0]), 0.0), 1.0)
    norm, norms = graph.op("Sqrt", graph.row_sums(graph.op("Mul", z, z))), np.linalg.norm(node["points"], axis=1)
    columns = [one] * (len(node["shares"]) + 1)
    for place in np.flatnonzero(node["shares"] > 0):
        share, k = float(node["shares"][place]), int(node["neighbours"][place])
        squares = graph.squares(norm, norms[:, None]) if node["by_norm"][place] else graph.squares(z, node["points"])
        best = graph.op("TopK", squares, np.array([k]), axis=1, largest=0, sorted=1)
        limit = graph.op("Add", graph.op("Mul", graph.columns(best, [k - 1]), 1.0 + 1e-9), 1e-18)
        near = graph.op("Cast", graph.op("LessOrEqual", squares, limit), to=11)
        mean = graph.op("Div", graph.op("MatMul", near, node["errors"][:, [place]]), graph.row_sums(near))
        mean = graph.op("Add", graph.op("Mul", mean, share), 1.0 - share)
        columns[place] = graph.op("Max", mean, float(node["least"]))
    last = len(node["shares"])
    return graph.columns(
        graph.op("Concat", *columns, axis=1), np.where(np.asarray(node["column"]) < 0, last, node["column"])
    )


def onnx_bounds(graph: Graph, numbers: Node, place: int, values: dict[str, str | None]) -> tuple[str, str]:
    """Lower and upper bounds (n_rows, n_coordinates) in mm at a stored level, of `values`: position, difficulty,
    outside and norms.
    """
    table, position, difficulty = numbers["tables"][place], values["position"], values["difficulty"]
    sides = [table["sides"][0, :, side][None] for side in (0, 1)]
    steps = sides if difficulty is None else [graph.op("Mul", difficulty, side) for side in sides]
    bounds = [graph.op("Add", position, step) for step in steps]
    if numbers["growths"] is None:
        return bounds[0], bounds[1]
    widest = _widest(graph, numbers, table, values["norms"])
    for side, kind in enumerate(("Sub", "Add")):
        far = graph.op(kind, position, widest)
        if numbers["has_spread"]:
            far = graph.op(("Min", "Max")[side], bounds[side], far)
        bounds[side] = graph.op("Where", values["outside"], far, bounds[side])
    return bounds[0], bounds[1]


def _widest(graph: Graph, numbers: Node, table: Node, norms: str | None) -> str:
    share = graph.op("Max", graph.op("Div", norms, float(numbers["surroundings"]["radius"])), 1.0)
    x, parts = graph.op("Log", share), [graph.constant(table["limits"])]
    for growth, limits in zip(numbers["growths"], table["growth_limits"], strict=True):
        near = graph.op("Min", x, float(growth["reach"]))
        grown = graph.op("Mul", near, growth["slope"][None])
        grown = graph.op("Add", grown, graph.op("Mul", graph.op("Mul", near, near), growth["bend"][None]))
        beyond = graph.op("Mul", graph.op("Sub", x, near), growth["steepest"][None])
        grown = graph.op("Exp", graph.op("Add", graph.op("Add", grown, beyond), growth["floor"][None]))
        parts.append(graph.op("Mul", grown, limits))
    return reduce(lambda a, b: graph.op("Max", a, b), parts)


def onnx_failures(
    graph: Graph, node: Node, commands: str, bounds: list[tuple[str, str]]
) -> tuple[str, list[str], list[tuple[str, str]]]:
    """The probability (n_rows, 1) that the pose fails, where it may by level, and bounds that hold failed poses."""
    probability = one_tree(graph, node["tree"], commands)
    flags = [graph.op("Greater", probability, float(least)) for least in node["least"]]
    widened = [
        (
            graph.op("Where", flag, graph.op("Min", lower, node["lower"][None]), lower),
            graph.op("Where", flag, graph.op("Max", upper, node["upper"][None]), upper),
        )
        for flag, (lower, upper) in zip(flags, bounds, strict=True)
    ]
    return probability, flags, widened


SPACE_WRITERS: dict[str, Callable[[Graph, Node, str, int], str]] = {"scaled": _scaled, "arcs": _arcs}
