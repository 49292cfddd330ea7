from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize, rosen, rosen_der

from softkin.core.samples import Array
from softkin.models.estimators.quick_lbfgs import Optimum, quick_lbfgs

Loss = Callable[[Array], tuple[float, Array]]


def valley(x: Array) -> tuple[float, Array]:
    """Rosenbrock's banana."""
    return float(rosen(x)), rosen_der(x)


def cliff(x: Array) -> tuple[float, Array]:
    """No number beyond 1, and a gradient that leads there: a line search breaks down."""
    return (float("nan"), np.full_like(x, np.nan)) if x[0] > 1 else (-float(x.sum()), -np.ones_like(x))


def of_scipy(loss: Loss, start: Array, bounds: tuple[Array, Array] | None = None, **options: Any) -> Any:
    pairs = None if bounds is None else list(zip(*bounds, strict=True))
    return minimize(loss, start, method="L-BFGS-B", jac=True, bounds=pairs, options=options)


def check(got: Optimum, expected: Any) -> None:
    np.testing.assert_array_equal(got.x, expected.x)
    np.testing.assert_equal(got.fun, expected.fun)
    assert (got.nit, got.status, got.message) == (expected.nit, expected.status, expected.message)


@given(n=st.integers(2, 30), seed=st.integers(0, 1000), max_iter=st.integers(1, 80), bounded=st.booleans())
def test_the_optimum_is_scipys_to_the_bit(n: int, seed: int, max_iter: int, bounded: bool) -> None:
    start = np.random.default_rng(seed).uniform(-2, 2, n)
    low = np.where(np.arange(n) % 3, -np.inf, start - 0.3)
    high = np.where(np.arange(n) % 4 < 2, np.inf, start + 0.2)
    bounds = (low, high) if bounded else None
    calls: list[Array] = []

    def recorded(x: Array) -> tuple[float, Array]:
        calls.append(x.copy())
        return valley(x)

    got = quick_lbfgs(recorded, start, max_iter=max_iter, tolerance=1e-6, bounds=bounds)
    expected = of_scipy(valley, start, bounds, maxiter=max_iter, gtol=1e-6)
    check(got, expected)
    assert len(calls) == expected.nfev
    np.testing.assert_array_equal(calls[0], start)


@pytest.mark.parametrize(
    ("loss", "max_iter", "max_calls", "status"), [(valley, 500, 15_000, 0), (valley, 500, 7, 1), (cliff, 9, 15_000, 2)]
)
def test_a_search_ends_as_scipys_does(loss: Loss, max_iter: int, max_calls: int, status: int) -> None:
    start = np.zeros(4)
    got = quick_lbfgs(loss, start, max_iter=max_iter, tolerance=1e-5, max_calls=max_calls)
    check(got, of_scipy(loss, start, maxiter=max_iter, gtol=1e-5, maxfun=max_calls))
    assert got.status == status
    np.testing.assert_array_equal(start, 0.0)
