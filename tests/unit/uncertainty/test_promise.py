from __future__ import annotations

from dataclasses import replace

import joblib
import numpy as np
import pytest

from softkin.core.samples import Samples
from softkin.uncertainty.calibration_data import PointCalibration
from softkin.uncertainty.conformal import conformal_limits, weighted_limits
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.spec import MARGINAL
from softkin.uncertainty.promise import BY_BLOCK, Promise, calibration_rows, calibration_set, promised, promised_methods


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
