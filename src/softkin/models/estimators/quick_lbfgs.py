"""scipy's L-BFGS-B around a loss that costs little, equal to the bit: what `minimize` adds to each call is left out."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import _lbfgsb
from scipy.optimize._lbfgsb_py import status_messages, task_messages

from softkin.core.samples import Array

#: scipy's own settings: pairs that stand for the Hessian, relative decrease at which a search ends, calls, and calls of
#: one line search.
PAIRS, LEAST_DECREASE, MAX_CALLS, MAX_LINE_SEARCH = 10, 2.2204460492503131e-09, 15_000, 20
#: What `setulb` asks for, and why it is told to stop, as its tasks number them.
NEW_ITERATION, LOSS_AND_GRADIENT, CONVERGED, STOP = 1, 3, 4, 5
TOO_MANY_CALLS, TOO_MANY_ITERATIONS = 502, 504
#: How it is told which bounds a number has.
LOWER, BOTH, UPPER = 1, 2, 3


class Optimum(NamedTuple):
    """Where a search ended: `x` (n,), its loss, iterations, and `status`: 0 converged, 1 stopped at a bound, 2 broken
    down, which `message` names.
    """

    x: Array
    fun: float
    nit: int
    status: int
    message: str


def quick_lbfgs(
    loss: Callable[[Array], tuple[float, Array]],
    start: Array,
    *,
    max_iter: int,
    tolerance: float,
    max_calls: int = MAX_CALLS,
    bounds: tuple[Array, Array] | None = None,
) -> Optimum:
    """The minimum of a loss of one vector that `minimize(method="L-BFGS-B", jac=True)` finds, from the same calls.

    `minimize` compares, copies and checks each vector several times, which costs as much as Huber's loss of some
    hundred rows.

    Parameters:
        loss: loss and gradient (n,) at a vector (n,), which it does not change; a call may overwrite the gradient
            of the call before.
        start: the first vector, within the bounds.
        max_iter: iterations at most; scipy's `maxiter`.
        tolerance: largest component of a gradient that counts as none; scipy's `gtol`.
        max_calls: calls of `loss` after which no iteration begins; scipy's `maxfun`.
        bounds: lower and upper ones, each (n,), infinite where there is none; None: no bounds.

    Source: scipy 1.17, `_minimize_lbfgsb`, whose Fortran-born core `setulb` this calls in the same way; Byrd, Lu,
    Nocedal and Zhu (1995).
    """
    x, n = np.array(start, dtype=np.float64), len(start)
    low, high, kinds = np.zeros(n), np.zeros(n), np.zeros(n, dtype=np.int32)
    if bounds is not None:
        has_low, has_high = np.isfinite(bounds[0]), np.isfinite(bounds[1])
        low[has_low], high[has_high] = bounds[0][has_low], bounds[1][has_high]
        kinds[:] = np.select([has_low & has_high, has_low, has_high], [BOTH, LOWER, UPPER])
    value, gradient = 0.0, np.zeros(n)
    work = np.zeros(2 * PAIRS * n + 5 * n + 11 * PAIRS**2 + 8 * PAIRS)
    integers = [np.zeros(size, dtype=np.int32) for size in (3 * n, 2, 4, 44, 2)]
    places, task, logical, saved, line_search = integers
    numbers = np.zeros(29)
    factor = LEAST_DECREASE / np.finfo(np.float64).eps
    n_iterations = n_calls = 0
    while True:
        _lbfgsb.setulb(
            PAIRS, x, low, high, kinds, value, gradient, factor, tolerance, work, places, task, logical, saved,
            numbers, MAX_LINE_SEARCH, line_search
        )  # fmt: skip
        if task[0] == LOSS_AND_GRADIENT:
            value, gradient = loss(x)
            n_calls += 1
        elif task[0] == NEW_ITERATION:
            n_iterations += 1
            if n_iterations >= max_iter:
                task[:] = STOP, TOO_MANY_ITERATIONS
            elif n_calls > max_calls:
                task[:] = STOP, TOO_MANY_CALLS
        else:
            break
    is_stopped = n_calls > max_calls or n_iterations >= max_iter
    status = 0 if task[0] == CONVERGED else 1 if is_stopped else 2
    return Optimum(x, value, n_iterations, status, f"{status_messages[task[0]]}: {task_messages[task[1]]}")
