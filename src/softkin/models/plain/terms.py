"""Terms of polynomials at many rows, by numpy alone. Exported Python files hold a copy of this text."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from softkin.models.plain.kernels import Values


def terms_of_many(factors: Any, n_features: int) -> Callable[[Values], Values]:
    """The function from features (n_rows, n_features) to terms (n_terms, n_rows): products, from left to right, of the
    features whose places are in each row of `factors` (n_terms, degree); the place `n_features` is 1. What terms begin
    with in common is multiplied once.
    """
    places: dict[tuple[int, ...], int] = {}
    steps: list[tuple[int, int]] = []
    wanted = [tuple(int(place) for place in row if place < n_features) for row in factors]
    for term in wanted:
        for length in range(len(term) + 1):
            if term[:length] not in places:
                places[term[:length]] = len(places)
                if length:
                    steps.append((places[term[: length - 1]], term[length - 1]))
    kept = np.array([places[term] for term in wanted], dtype=np.int64)

    def answer(x: Values) -> Values:
        columns = np.ascontiguousarray(x.T)
        products = np.empty((len(steps) + 1, len(x)))
        products[0] = 1.0
        for place, (before, feature) in enumerate(steps, 1):
            np.multiply(products[before], columns[feature], out=products[place])
        return np.asarray(products[kept])

    return answer
