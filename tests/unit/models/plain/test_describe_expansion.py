from __future__ import annotations

from decimal import Decimal, localcontext
from functools import cache

import numpy as np

from softkin.core.samples import Array
from softkin.models.plain.describe_expansion import expanded
from softkin.models.plain.expansion import expansion
from softkin.models.plain.kernels import SHAPES, Node

POINTS = np.random.default_rng(0).uniform(-1.7, 1.7, (150, 2))
TERMS: list[Node] = [
    {"shape": "product", "constant": 0.3, "rate": 1.0, "offset": 40.0, "power": 2},
    {"shape": "exponential", "constant": 300.0, "rate": 0.5, "lengths": np.array([9.0, 8.0])},
]
#: Inside, and as far out as the expansion holds.
ROWS = np.array([[0.3, -0.8], [1.7, 1.6], [-2.4, 2.0]])


@cache
def cancelling() -> Array:
    """Weights (150, 1) of a nearly noiseless function: those of the kernel's inverse."""
    kernel = sum(SHAPES[term["shape"]](term, POINTS)(POINTS) for term in TERMS) + 1e-8 * np.eye(len(POINTS))
    return np.asarray(np.linalg.solve(kernel, np.sin(POINTS[:, :1]) + POINTS[:, 1:] ** 2))


def exactly(row: Array, weights: Array) -> float:
    """The sum over the points, with sixty digits."""
    product, exponential = TERMS
    with localcontext() as context:
        context.prec = 60
        x, total = [Decimal(float(value)) for value in row], Decimal(0)
        lengths = [Decimal(float(length)) for length in exponential["lengths"]]
        for point, weight in zip(POINTS, weights[:, 0], strict=True):
            p = [Decimal(float(value)) for value in point]
            inner = sum(a * b for a, b in zip(x, p, strict=True)) + Decimal(product["offset"])
            apart = sum(((a - b) / length) ** 2 for a, b, length in zip(x, p, lengths, strict=True))
            kernel = Decimal(product["constant"]) * inner**2
            kernel += Decimal(exponential["constant"]) * Decimal(-apart / 2).exp()
            total += kernel * Decimal(float(weight))
        return float(total)


def test_it_is_the_sum_in_exact_arithmetic_where_the_sum_itself_is_not() -> None:
    parts = expanded(POINTS, TERMS, cancelling())
    assert parts is not None
    found, holds = expansion(parts)(ROWS)
    assert holds.all()
    exact = np.array([[exactly(row, cancelling())] for row in ROWS])
    summed = sum(SHAPES[term["shape"]](term, POINTS)(ROWS) for term in TERMS) @ cancelling()
    assert np.abs(found - exact).max() < 1e-12
    assert np.abs(summed - exact).max() > 1e-10


def test_what_does_not_cancel_stays_as_it_is() -> None:
    assert expanded(POINTS, TERMS, 1e-6 * np.ones((150, 1))) is None


def test_kernels_that_are_no_short_series_stay_as_they_are() -> None:
    rough: Node = {"shape": "matern32", "constant": 300.0, "lengths": np.ones(2)}
    narrow: Node = TERMS[1] | {"lengths": np.array([0.1, 0.1])}
    assert expanded(POINTS, [*TERMS, rough], cancelling()) is None
    assert expanded(POINTS, [narrow], 1e3 * cancelling()) is None
