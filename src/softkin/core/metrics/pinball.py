"""The pinball loss, which quantile regressors are fitted and tuned by."""

from __future__ import annotations

import numpy as np

from softkin.core.samples import Array


def pinball_losses(true: Array, quantiles: Array, quantile: float) -> Array:
    """Pinball loss of predicted quantiles, elementwise; mm (Koenker and Bassett 1978)."""
    error = true - quantiles
    return np.asarray(np.maximum(quantile * error, (quantile - 1) * error))
