from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.core.metrics.point import (
    euclidean_errors,
    mae_mm,
    mape_percent,
    paper_metrics,
    point_metrics,
    r2,
    rmse_mm,
)

TRUE = np.array([[1.0, 2.0, 0.0], [3.0, 2.0, 4.0]])
PREDICTED = np.array([[2.0, 2.0, 0.0], [3.0, 2.0, 2.0]])
numbers = arrays(float, (6, 3), elements=st.floats(-1e3, 1e3).map(lambda x: round(x, 3)))


def test_by_hand() -> None:
    assert rmse_mm(TRUE, PREDICTED) == pytest.approx((np.sqrt(0.5) + 0 + np.sqrt(2.0)) / 3)  # averaged, not pooled
    assert mae_mm(TRUE, PREDICTED) == pytest.approx((0.5 + 0 + 1.0) / 3)
    assert r2(TRUE, PREDICTED) == pytest.approx(((1 - 1 / 2) + 1.0 + (1 - 4 / 8)) / 3)
    assert mape_percent(TRUE, PREDICTED) == pytest.approx(100 * (0.5 + 0 + 0.25) / 3)
    np.testing.assert_allclose(euclidean_errors(TRUE, PREDICTED), [[1.0], [2.0]])


def test_a_coordinate_that_never_moves_scores_one_only_when_exact() -> None:
    off = PREDICTED + np.array([0.0, 1e-12, 0.0])
    assert r2(TRUE, PREDICTED) - r2(TRUE, off) == pytest.approx(1 / 3)


@given(numbers, numbers)
def test_laws(true: np.ndarray, predicted: np.ndarray) -> None:
    assert rmse_mm(true, predicted) >= mae_mm(true, predicted) - 1e-9
    assert r2(true, predicted) <= 1.0
    for metric in (rmse_mm, mae_mm, mape_percent):
        assert metric(true, predicted) >= 0.0
        assert metric(true, true) == 0.0
    assert np.allclose(euclidean_errors(true, predicted), euclidean_errors(predicted, true))


@given(numbers, numbers, st.floats(0.5, 100.0))
def test_errors_follow_the_unit_and_r2_does_not(true: np.ndarray, predicted: np.ndarray, factor: float) -> None:
    assert rmse_mm(factor * true, factor * predicted) == pytest.approx(factor * rmse_mm(true, predicted), rel=1e-6)
    wide = true + np.arange(6)[:, None] * 1e4  # far from a constant coordinate
    assert r2(factor * wide, factor * predicted) == pytest.approx(r2(wide, predicted), rel=1e-6)


def test_informative_metrics_leave_out_what_never_moves() -> None:
    rng = np.random.default_rng(0)
    moving = rng.standard_normal((50, 3))
    true = np.hstack([np.full((50, 3), 7.0), moving])
    predicted = np.hstack([np.full((50, 3), 7.0), moving + 0.3])
    values = point_metrics(true, predicted, np.repeat([False, True], 3))
    assert values["rmse_mm"] == pytest.approx(0.15)
    assert [values["rmse_informative_mm"], values["mae_informative_mm"]] == pytest.approx([0.3, 0.3])
    assert values["r2_informative"] == pytest.approx(r2(moving, moving + 0.3))
    assert [values["euclidean_mean_mm"], values["euclidean_p95_mm"]] == pytest.approx([0.3 * np.sqrt(3)] * 2)


def test_case_32_a_planar_robot_is_averaged_over_its_two_coordinates() -> None:
    rng = np.random.default_rng(0)
    planar, off = rng.normal(100, 10, (20, 2, 2)), rng.normal(0, 1, (20, 2, 2))
    true = np.pad(planar, ((0, 0), (0, 0), (0, 1))).reshape(20, 6)
    predicted = np.pad(planar + off, ((0, 0), (0, 0), (0, 1))).reshape(20, 6) + 1e-9 * np.array([0, 0, 1, 0, 0, 1])
    flat = planar.reshape(20, 4), (planar + off).reshape(20, 4)
    metrics = {"rmse_mm": rmse_mm, "mae_mm": mae_mm, "r2": r2, "mape_percent": mape_percent}
    assert paper_metrics(true, predicted) == {name: metric(*flat) for name, metric in metrics.items()}
    values = point_metrics(true, predicted, np.array([True, True, False] * 2))
    assert values["mape_percent"] == values["mape_informative_percent"] < 10
