from __future__ import annotations

from dataclasses import replace

import joblib
import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import conformal_limits, p_values, weighted_limits
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.spec import MARGINAL
from softkin.uncertainty.promise import (
    BY_BLOCK,
    Promise,
    calibration_rows,
    calibration_set,
    own_rows,
    promised,
    promised_methods,
    worth_of_alarm,
    worth_of_p_values,
)


def test_each_block_counts_alike() -> None:
    rows, promise = calibration_rows(np.array([5, 5, 5, 7, 9, 9]))
    assert (promise.n_blocks, promise.n_rows) == (3, 3)
    drawn = [sorted(part.tolist()) for part in np.split(rows, 3)]
    assert drawn[:2] == [[0, 1, 2], [3, 3, 3]]
    assert sorted(set(drawn[2])) == [4, 5]


@pytest.mark.parametrize(
    ("n_blocks", "level", "holds"), [(8, 0.9, False), (9, 0.9, True), (18, 0.95, False), (19, 0.95, True)]
)
def test_k_blocks_promise_k_of_k_plus_one(n_blocks: int, level: float, holds: bool) -> None:
    assert Promise(n_blocks, 7).holds(level) == holds
    assert not Promise(n_blocks, 7).holds(level, two_sided=True)
    method = INTERVAL_METHODS["scp_crepes"]
    assert Promise(n_blocks, 7).guarantee(method, level) == (BY_BLOCK if holds else f"no guarantee ({n_blocks} blocks)")


def test_the_level_that_is_asked_for_is_that_of_hierarchical_conformal_prediction() -> None:
    """The weighted quantile of scores that each count one over the rows of their block, and of one at infinity."""
    scores = np.random.default_rng(0).exponential(size=(12 * 5, 1))
    promise = Promise(12, 5)
    for level in (0.5, 0.8, 0.9):
        expected = weighted_limits(scores, np.full(60, 1 / 5), np.ones(1), [level])
        np.testing.assert_array_equal(conformal_limits(scores, [promise.asked(level)]), expected[0])
    assert conformal_limits(scores, [promise.asked(0.95)])[0, 0] == scores.max()


def test_the_future_is_one_block_and_asked_for_as_it_is() -> None:
    assert Promise(1, 50).asked(0.9) == 0.9
    assert Promise(1, 50).guarantee(INTERVAL_METHODS["scp_crepes"], 0.9) == "no guarantee (1 block)"


def test_rows_that_were_split_one_by_one_are_left_as_they_are() -> None:
    rows = Samples(np.zeros((4, 1)), np.zeros((4, 3)))
    calibration, numbers, promise = calibration_set(rows)
    assert calibration is rows
    assert numbers.tolist() == [0, 1, 2, 3]
    assert promise is None
    method = INTERVAL_METHODS["scp_mapie"]
    assert promised(method, None) is method
    assert promised_methods({"a": method}, None) == {"a": method}


def calibrated_on(n: int) -> PointCalibration:
    rng = np.random.default_rng(n)
    zero, commands = np.zeros((n, 3)), rng.normal(size=(n, 1))
    return PointCalibration(zero, rng.normal(size=(n, 3)), zero[:2], commands, commands, commands[:2])


@pytest.mark.parametrize("name", ["scp_mapie", "scp_crepes", "scp_distance", "cps"])
def test_methods_give_the_intervals_of_the_promise(name: str) -> None:
    method, promise = INTERVAL_METHODS[name], Promise(12, 5)
    by_block = promised(method, promise)
    data, levels = calibrated_on(60), [0.5, 0.8]
    two_sided = name == "cps"
    asked = [promise.asked(level, two_sided) for level in levels]
    np.testing.assert_array_equal(by_block.intervals(data, levels), method.intervals(data, asked))
    assert (by_block.intervals(data, [0.95, 0.99]) == by_block.intervals(data, [0.99])).all()
    assert np.isfinite(by_block.intervals(data, [0.99])).all()
    assert by_block.guarantee == ("no guarantee (12 blocks)" if two_sided else BY_BLOCK)


def test_a_promised_method_can_be_stored(tmp_path: object) -> None:
    method = promised(INTERVAL_METHODS["scp_crepes"], Promise(12, 5))
    joblib.dump(method, f"{tmp_path}/method.joblib")
    data = calibrated_on(60)
    stored = joblib.load(f"{tmp_path}/method.joblib")
    np.testing.assert_array_equal(stored.intervals(data, [0.9]), method.intervals(data, [0.9]))


def test_refits_promise_nothing_of_blocks() -> None:
    method = replace(INTERVAL_METHODS["cv_plus"], guarantee=MARGINAL)
    assert promised(method, Promise(30, 5)).intervals is method.intervals
    assert promised(method, Promise(30, 5)).guarantee == "no guarantee"
    assert promised(INTERVAL_METHODS["cv_plus"], Promise(30, 5)).guarantee == "no guarantee"
    assert promised(INTERVAL_METHODS["qr"], Promise(30, 5)) == INTERVAL_METHODS["qr"]


def test_held_out_blocks_are_covered_where_rows_would_not_be() -> None:
    """Blocks share most of their error: counting rows covers too few of new blocks, counting blocks covers enough."""
    rng = np.random.default_rng(0)
    by_row, by_block = [], []
    for _ in range(300):
        errors = np.abs(rng.normal(size=(13, 1)) + 0.1 * rng.normal(size=(13, 20)))
        scores, new = errors[:12].reshape(-1, 1), errors[12]
        promise = Promise(12, 20)
        by_row.append((new <= conformal_limits(scores, [0.9])[0, 0]).mean())
        by_block.append((new <= conformal_limits(scores, [promise.asked(0.9)])[0, 0]).mean())
    assert np.mean(by_row) < 0.875
    assert np.mean(by_block) > 0.89


def blocks_of_rows(rng: np.random.Generator, n_blocks: int, n_rows: int) -> np.ndarray:
    """Scores (n_blocks, n_rows) that are alike within a block."""
    return np.abs(rng.standard_normal((n_blocks, 1)) + 0.05 * rng.standard_normal((n_blocks, n_rows)))


@pytest.mark.parametrize("smooth", [False, True])
def test_p_values_hold_for_a_row_of_a_new_block_where_they_count_blocks(smooth: bool) -> None:
    """Over 1000 draws of 12 blocks: at most 10 % of rows of a new one; counting rows it is more."""
    rng, promise, found = np.random.default_rng(0), Promise(12, 20), {1: 0, own_rows(Promise(12, 20)): 0}
    for _ in range(1000):
        scores = blocks_of_rows(rng, promise.n_blocks + 1, promise.n_rows)
        for own in found:
            small = p_values(scores[:-1].ravel(), scores[-1, :1], rng=rng if smooth else None, own=own)
            found[own] += int((small <= 0.1).sum())
    assert found[20] / 1000 <= 0.1 + 3 * np.sqrt(0.1 * 0.9 / 1000)
    assert found[1] / 1000 > 0.12


def test_p_values_and_limits_agree_on_who_is_outside() -> None:
    promise, scores = Promise(12, 20), blocks_of_rows(np.random.default_rng(1), 12, 20).ravel()
    new = np.linspace(0.0, 4.0, 300)
    limit = conformal_limits(scores[:, None], [promise.asked(0.9)])[0, 0]
    np.testing.assert_array_equal(p_values(scores, new, own=own_rows(promise)) > 0.1, new <= limit)


def test_where_blocks_are_too_few_rows_count_and_nothing_is_promised() -> None:
    assert [own_rows(promise) for promise in (None, Promise(8, 5), Promise(9, 5), Promise(1, 40))] == [1, 1, 5, 1]
    assert worth_of_p_values(None) == worth_of_alarm(None) == ""
    assert "P-values have no guarantee: they count rows" in worth_of_p_values(Promise(1, 40))
    assert "calibrated on 1 block of rows" in worth_of_p_values(Promise(1, 40))
    assert "P-values count the 9 blocks" in worth_of_p_values(Promise(9, 5))
    assert "The rate of false alarms has no guarantee" in worth_of_alarm(Promise(9, 5))
