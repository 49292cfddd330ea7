"""Sums over a kernel's points as few powers of the features, by numpy alone. Exported Python files hold a copy of this
text.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from softkin.models.plain.kernels import Node, Values


def expansion(parts: list[Node]) -> Callable[[Values], tuple[Values, Any]]:
    """Targets (n_rows, n_targets) of features (n_rows, n_features), and in which rows (n_rows,) they hold.

    Each part is the sum of products of z, features in units of its `lengths`, raised to `powers` (n_terms, n_features)
    and times `weights` (n_terms, n_targets); all times exp(-rate |z|^2). It holds where |z| is at most its `reach`.
    """
    several = [_part(one) for one in parts]

    def answer(x: Values) -> tuple[Values, Any]:
        targets, holds = several[0](x)
        for part in several[1:]:
            added, near = part(x)
            targets += added
            holds = holds & near
        return targets, holds

    return answer


def _part(node: Node) -> Callable[[Values], tuple[Values, Any]]:
    lengths, powers, weights, rate, reach = (node[key] for key in ("lengths", "powers", "weights", "rate", "reach"))
    columns, steps = list(powers.T), int(powers.max()) + 1

    def answer(x: Values) -> tuple[Values, Any]:
        z = x / lengths
        squares = np.einsum("ij,ij->i", z, z)
        near = squares <= reach * reach
        if not near.all():
            z, squares = np.where(near[:, None], z, 0.0), np.where(near, squares, 0.0)
        table = np.ones((*z.shape, steps))
        table[..., 1:] = z[..., None]
        np.multiply.accumulate(table, axis=2, out=table)
        products = table[:, 0, columns[0]]
        for place, column in enumerate(columns[1:], 1):
            products *= table[:, place, column]
        targets = products @ weights
        return (np.exp(-rate * squares)[:, None] * targets if rate else targets), near

    return answer
