"""Point metrics of predicted positions. Arrays are (n_rows, n_coordinates) in mm unless said otherwise.

The first four follow the paper's Section 4 with the conventions that give its printed cells: each is computed per
coordinate and then averaged over coordinates with equal weight.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array, measured_coordinates


def rmse_mm(true: Array, predicted: Array) -> float:
    """sqrt(mean (x - x_hat)^2) per coordinate, averaged over coordinates (not pooled); mm."""
    from sklearn import metrics

    return float(metrics.root_mean_squared_error(true, predicted))


def mae_mm(true: Array, predicted: Array) -> float:
    """Mean |x - x_hat| per coordinate, averaged over coordinates; mm."""
    from sklearn import metrics

    return float(metrics.mean_absolute_error(true, predicted))


def r2(true: Array, predicted: Array) -> float:
    """1 - SS_residual / SS_total per coordinate, averaged; of a coordinate that never moves, 1 if predicted exactly,
    else 0 (scikit-learn's definition).
    """
    from sklearn import metrics

    return float(metrics.r2_score(true, predicted))


def mape_percent(true: Array, predicted: Array) -> float:
    """100 mean |x - x_hat| / max(|x|, eps) per coordinate, averaged (scikit-learn's definition); percent."""
    from sklearn import metrics

    return 100.0 * float(metrics.mean_absolute_percentage_error(true, predicted))


def euclidean_errors(true: Array, predicted: Array) -> Array:
    """Distance between true and predicted marker, (n_rows, n_markers); mm."""
    difference = (predicted - true).reshape(len(true), -1, 3)
    return np.asarray(np.linalg.norm(difference, axis=2))


#: Column of point_metrics.csv -> metric. The paper's order.
PAPER_METRICS: dict[str, Callable[[Array, Array], float]] = {
    "rmse_mm": rmse_mm,
    "mae_mm": mae_mm,
    "r2": r2,
    "mape_percent": mape_percent,
}
#: Whether a larger value is better.
LARGER_IS_BETTER = {"rmse_mm": False, "mae_mm": False, "r2": True, "mape_percent": False}


def paper_metrics(true: Array, predicted: Array) -> dict[str, float]:
    """The paper's metrics; those of a planar robot are averaged over its two coordinates: the third is not measured."""
    measured = measured_coordinates(true)
    return {name: metric(true[:, measured], predicted[:, measured]) for name, metric in PAPER_METRICS.items()}


def point_metrics(true: Array, predicted: Array, informative: NDArray[np.bool_]) -> dict[str, float]:
    """All point metrics of one subset.

    `informative` (n_coordinates,) masks the coordinates that move; the `_informative` metrics are over those only,
    and the Euclidean ones (mean, and 95th percentile over rows) are averaged over the markers that have one.
    """
    values = paper_metrics(true, predicted)
    moving_true, moving_predicted = true[:, informative], predicted[:, informative]
    values |= {
        "rmse_informative_mm": rmse_mm(moving_true, moving_predicted),
        "mae_informative_mm": mae_mm(moving_true, moving_predicted),
        "r2_informative": r2(moving_true, moving_predicted),
        "mape_informative_percent": mape_percent(moving_true, moving_predicted),
    }
    markers = informative.reshape(-1, 3).any(axis=1)
    errors = euclidean_errors(true, predicted)[:, markers]
    return values | {
        "euclidean_mean_mm": float(errors.mean()),
        "euclidean_p95_mm": float(np.percentile(errors, 95, axis=0).mean()),
    }
