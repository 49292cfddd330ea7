from __future__ import annotations

import numpy as np
import pytest

from softkin.core.samples import Array
from softkin.evaluation.intervals_in_time import after, among, blocks
from softkin.evaluation.recorded_names import ADAPTIVE, FIXED_WEIGHTS, PLAIN

LEVEL = 0.9


def drifting(n_rows: int, seed: int) -> Array:
    """Absolute errors (n_rows, 2) that become five times as large in time."""
    rng = np.random.default_rng(seed)
    return np.abs(rng.standard_normal((n_rows, 2))) * np.linspace(1, 5, n_rows)[:, None]


def coverage(errors: Array, halves: Array) -> float:
    return float((errors <= halves).mean())


def test_where_errors_grow_in_time_adaptive_inference_keeps_up_and_late_rows_count_more() -> None:
    errors = drifting(600, seed=0)
    halves = after(errors[:300], errors[300:], LEVEL)
    held = {name: coverage(errors[300:], of) for name, of in halves.items()}
    assert held[PLAIN] < held[FIXED_WEIGHTS]
    assert held[ADAPTIVE] == pytest.approx(LEVEL, abs=0.04)
    assert all(np.isfinite(of).all() for of in halves.values())


def test_among_calibration_rows_fixed_weights_follow_the_errors_of_the_time() -> None:
    errors = drifting(800, seed=0)
    order = np.arange(800)
    known = np.random.default_rng(1).random(800) < 0.5
    halves = among(errors[known], order[known], errors[~known], order[~known], LEVEL)
    new = errors[~known]
    quarter = len(new) // 4
    spread = {
        name: coverage(new[:quarter], np.broadcast_to(of, new.shape)[:quarter])
        - coverage(new[-quarter:], np.broadcast_to(of, new.shape)[-quarter:])
        for name, of in halves.items()
    }
    assert spread[PLAIN] > 0.2  # too wide at first, too narrow at last
    assert abs(spread[FIXED_WEIGHTS]) < spread[PLAIN] / 2


def test_blocks_hold_each_row_once() -> None:
    for n_rows in (3, 10, 101):
        assert np.concatenate([rows for _, rows in blocks(n_rows)]).tolist() == list(range(n_rows))
    assert [name for name, _ in blocks(8)][-1] == "block 4 of 4"
