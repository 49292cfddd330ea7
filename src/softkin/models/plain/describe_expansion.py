"""Kernels whose weights cancel, expanded in powers of the features.

A Gaussian process of a nearly noiseless robot weighs a kernel that is nearly flat with large numbers of either sign:
of sums of 1e9 there are left a few units, and rounding takes seven digits of these. The kernel is smooth there:
exp(-r |z - p|^2) = exp(-r |z|^2) exp(-r |p|^2) exp(2 r z.p), and a few powers of z.p are all of the last factor to the
last digit. Summed over the points p once, with twice the digits, they are a hundred numbers that do not cancel.
"""

from __future__ import annotations

import math
from decimal import Decimal, localcontext
from itertools import combinations_with_replacement
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.models.plain.kernels import SHAPES, Node

#: Weights are said to cancel where rounding of their sum, in standard deviations of a target, may be larger.
ROUNDING = 1e-12
#: What the powers that are left out add at most, in the same units.
LEFT_OUT = 1e-13
#: How far from the middle of the points the expansion holds, in distances of the farthest one.
REACH = 2.0
#: Rows whose sums are looked at.
LOOKED_AT = 100
#: Powers at most for each point: one takes a product where a point takes an exponential.
MOST_TERMS = 2
DIGITS = 40
#: 2**27 + 1 splits a number in halves (Dekker 1971).
SPLITTER = 134217729.0
#: A number of twice the digits: the sum of two.
Double = tuple[Array, Array]


def expanded(points: Array, terms: list[Node], weights: Array) -> list[Node] | None:
    """The parts that `expansion` takes; None where weights do not cancel, or powers are more than twice the points.

    Parameters:
        points: (n, n_features).
        terms: of the kernel.
        weights: (n, n_targets).
    """
    if any(term["shape"] not in ("exponential", "product") for term in terms):
        return None
    rows = points[:: max(1, len(points) // LOOKED_AT)]
    sizes = np.abs(sum(SHAPES[term["shape"]](term, points)(rows) for term in terms)) @ np.abs(weights)
    if np.finfo(float).eps * sizes.max() <= ROUNDING:
        return None
    degrees = [_degree(term, points, weights) for term in terms]
    n_features = points.shape[1]
    if sum(math.comb(degree + n_features, n_features) for degree in degrees) > MOST_TERMS * len(points):
        return None
    return [_part(term, points, weights, degree) for term, degree in zip(terms, degrees, strict=True)]


def _degree(term: Node, points: Array, weights: Array) -> int:
    """How many powers there are to take."""
    if term["shape"] == "product":
        return int(term["power"])
    largest = 2 * term["rate"] * REACH * np.square(points / term["lengths"]).sum(axis=1).max()
    left, degree = term["constant"] * np.abs(weights).sum(axis=0).max(), 0
    while left > LEFT_OUT or degree < largest:
        degree += 1
        left *= largest / degree
        if degree > len(points):
            break
    return degree


def _part(term: Node, points: Array, weights: Array, degree: int) -> Node:
    """The powers of one term of the kernel, with their weights."""
    is_product = term["shape"] == "product"
    lengths = np.ones(points.shape[1]) if is_product else np.asarray(term["lengths"], dtype=np.float64)
    rate = 0.0 if is_product else float(term["rate"])
    z, envelope = _exactly(points, lengths, rate)
    powers = _powers(points.shape[1], degree)
    products: dict[tuple[int, ...], Double] = {tuple(powers[0]): envelope}
    sums = np.empty((len(powers), weights.shape[1]))
    nothing = np.zeros(len(points))
    for place, row in enumerate(powers):
        key = tuple(row)
        if key not in products:
            first = int(np.flatnonzero(row)[0])
            less = tuple(int(power) - (column == first) for column, power in enumerate(row))
            products[key] = _times(products[less], z[first])
        for target, weight in enumerate(weights.T):
            sums[place, target] = math.fsum(np.concatenate(_times(products[key], (weight, nothing))).tolist())
    factors = [_factor(term, [int(power) for power in row]) for row in powers]
    reach = np.inf if is_product else REACH * np.sqrt(np.square(points / lengths).sum(axis=1).max())
    return {
        "lengths": lengths,
        "rate": rate,
        "reach": float(reach),
        "powers": powers,
        "weights": np.array(factors)[:, None] * sums,
    }


def _factor(term: Node, powers: list[int]) -> float:
    """What z^powers p^powers is multiplied by in the series of the term, without its envelope."""
    degree, several = sum(powers), math.prod(map(math.factorial, powers))
    if term["shape"] == "product":
        power, rest = int(term["power"]), int(term["power"]) - degree
        times = math.factorial(power) / math.factorial(rest) / several
        return float(term["constant"] * times * term["rate"] ** degree * term["offset"] ** rest)
    return float(term["constant"] * (2 * term["rate"]) ** degree / several)


def _powers(n_features: int, degree: int) -> NDArray[np.int64]:
    """All powers (n_terms, n_features) of at most this degree, the lowest first."""
    chosen = [c for k in range(degree + 1) for c in combinations_with_replacement(range(n_features), k)]
    return np.array([[one.count(column) for column in range(n_features)] for one in chosen], dtype=np.int64)


def _exactly(points: Array, lengths: Array, rate: float) -> tuple[list[Double], Double]:
    """Columns of the points in units of the lengths, and exp(-rate |z|^2)."""
    with localcontext() as context:
        context.prec = DIGITS
        units = [Decimal(float(length)) for length in lengths]
        rows = [[Decimal(float(value)) / unit for value, unit in zip(row, units, strict=True)] for row in points]
        envelope = [(-Decimal(rate) * sum(value * value for value in row)).exp() for row in rows]
        return [_double(column) for column in zip(*rows, strict=True)], _double(envelope)


def _double(values: Any) -> Double:
    high = np.array([float(value) for value in values])
    return high, np.array([float(value - Decimal(near)) for value, near in zip(values, high.tolist(), strict=True)])


def _times(one: Double, other: Double) -> Double:
    """The product with twice the digits (Dekker 1971)."""
    (a, a_low), (b, b_low) = one, other
    product, (a_front, a_back), (b_front, b_back) = a * b, _halves(a), _halves(b)
    rest = ((a_front * b_front - product) + a_front * b_back + a_back * b_front) + a_back * b_back
    rest = rest + (a * b_low + a_low * b)
    high = product + rest
    return high, rest - (high - product)


def _halves(value: Array) -> Double:
    far = SPLITTER * value
    front = far - (far - value)
    return front, value - front
