"""Kernels between features and stored points, by numpy alone. Exported Python files hold a copy of this text."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Values = np.ndarray[Any, np.dtype[np.float64]]
Node = dict[str, Any]
#: Lower triangle L (n, n) -> function from b (n, n_rows) to the solution of L v = b.
Solver = Callable[[Values], Callable[[Values], Values]]
#: Side of the blocks that a triangle is solved by.
BLOCK = 128


def blockwise(lower: Values) -> Callable[[Values], Values]:
    """Forward substitution in blocks, whose triangles are inverted beforehand; each solution is refined once."""
    places = [slice(start, start + BLOCK) for start in range(0, len(lower), BLOCK)]
    blocks = [
        (place, lower[place, place], np.linalg.inv(lower[place, place]), lower[place, : place.start].copy())
        for place in places
    ]

    def solved(right: Values) -> Values:
        result = right.copy()
        for place, triangle, inverse, before in blocks:
            wanted = result[place] - before @ result[: place.start]
            found = inverse @ wanted
            result[place] = found + inverse @ (wanted - triangle @ found)
        return result

    return solved


def prior(term: Node, x: Values) -> Values:
    """The kernel (n_rows,) of each row with itself."""
    if term["shape"] != "product":
        return np.full(len(x), term["constant"])
    return np.asarray(term["constant"] * (term["rate"] * np.einsum("ij,ij->i", x, x) + term["offset"]) ** term["power"])


def _squares(term: Node, points: Values) -> Callable[[Values], Values]:
    """Squared distances (n_rows, n) to the points, in units of the `lengths` (n_features,)."""
    lengths = term["lengths"]
    columns = np.ascontiguousarray((points / lengths).T)

    def squares(x: Values) -> Values:
        apart = columns - (x / lengths)[:, :, None]
        apart *= apart
        return np.asarray(np.add.reduce(apart, axis=1))

    return squares


def _exponential(term: Node, points: Values) -> Callable[[Values], Values]:
    squares, constant, rate = _squares(term, points), term["constant"], -term["rate"]
    return lambda x: constant * np.exp(rate * squares(x))


def _matern32(term: Node, points: Values) -> Callable[[Values], Values]:
    squares, constant = _squares(term, points), term["constant"]

    def kernel(x: Values) -> Values:
        far = np.sqrt(squares(x)) * np.sqrt(3)
        return np.asarray(constant * ((1.0 + far) * np.exp(-far)))

    return kernel


def _matern52(term: Node, points: Values) -> Callable[[Values], Values]:
    squares, constant = _squares(term, points), term["constant"]

    def kernel(x: Values) -> Values:
        far = np.sqrt(squares(x)) * np.sqrt(5)
        return np.asarray(constant * ((1.0 + far + far * far / 3.0) * np.exp(-far)))

    return kernel


def _rational(term: Node, points: Values) -> Callable[[Values], Values]:
    squares, constant, rate, power = _squares(term, points), term["constant"], term["rate"], -term["power"]
    return lambda x: constant * (1 + squares(x) / rate) ** power


def _product(term: Node, points: Values) -> Callable[[Values], Values]:
    columns, constant, rate, offset, power = points.T, term["constant"], term["rate"], term["offset"], term["power"]
    return lambda x: constant * (rate * (x @ columns) + offset) ** power


#: Shapes of the terms of a kernel.
SHAPES = {
    "exponential": _exponential,
    "matern32": _matern32,
    "matern52": _matern52,
    "rational": _rational,
    "product": _product,
}
