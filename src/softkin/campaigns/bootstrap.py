"""One-sided p-values of a mean that has grown, by the bootstrap of a studentised mean (Efron and Tibshirani 1993,
16.4).

Resampling ends early where a p-value is clearly no small one (Besag and Clifford 1991).
"""

from __future__ import annotations

import numpy as np

from softkin.core.samples import Array

#: Resamples drawn at once, so that memory is bounded: this many times the number of values.
CHUNK = 2000
#: Resampling ends when this many resamples are as large as what was found.
ENOUGH = 200


def p_of_growth(differences: Array, *, resamples: int, seed: int) -> float:
    """p-value of the hypothesis that the mean of paired differences (n,) is at most 0.

    The share of resamples, drawn around the mean that was found, whose mean in units of its standard error is at least
    as large as the one that was found; 1 where the mean is at most 0.
    """
    return _p_value(differences, np.zeros(1), resamples, seed)


def p_of_growth_between(before: Array, now: Array, *, resamples: int, seed: int) -> float:
    """The same of samples (n,) and (m,) with no rows in common: the mean of `now` is at most that of `before`."""
    return _p_value(now, before, resamples, seed)


def _p_value(one: Array, other: Array, resamples: int, seed: int) -> float:
    """p-value of the mean of `one` being at most that of `other`."""
    growth = float(one.mean() - other.mean())
    if growth <= 0:
        return 1.0
    error = np.sqrt(_squared_error(one) + _squared_error(other))
    if error == 0:  # every value has grown by the same
        return 1.0 / (resamples + 1)
    rng, as_large, start = np.random.default_rng(seed), 0, 0
    while start < resamples and as_large < ENOUGH:
        size = min(CHUNK, resamples - start)
        drawn, others = (values[rng.integers(len(values), size=(size, len(values)))] for values in (one, other))
        growths = drawn.mean(axis=1) - others.mean(axis=1) - growth
        errors = np.sqrt(_squared_error(drawn) + _squared_error(others))
        as_large, start = as_large + int((growths * error >= growth * errors).sum()), start + size
    return (1 + as_large) / (start + 1)


def _squared_error(values: Array) -> Array:
    """Squared standard error of the mean over the last axis; 0 of a single value."""
    n = values.shape[-1]
    return np.asarray(values.var(axis=-1) / max(n - 1, 1))
