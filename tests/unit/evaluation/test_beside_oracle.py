from __future__ import annotations

import numpy as np
import pytest

from softkin.evaluation.beside_oracle import ratios

NONE = np.zeros(200, dtype=bool)


def test_a_band_over_draws_of_commands_holds_the_ratio() -> None:
    rng = np.random.default_rng(0)
    oracle, method = rng.uniform(1, 2, 200), rng.uniform(2, 4, 200)
    found = ratios(np.array([oracle, method]), [0, 0], np.arange(200), NONE)
    assert found["winkler_ratio_to_oracle"].tolist() == pytest.approx([1.0, method.mean() / oracle.mean()])
    assert found["ratio_low"][0] == found["ratio_high"][0] == pytest.approx(1.0)
    low, high = found["ratio_low"][1], found["ratio_high"][1]
    # The standard error of the ratio, to first order.
    error = np.std(method - oracle * method.mean() / oracle.mean()) / oracle.mean() / np.sqrt(200)
    assert (high - low) / 2 == pytest.approx(1.96 * error, rel=0.2)


def test_rows_of_a_command_are_drawn_together() -> None:
    rng = np.random.default_rng(0)
    method = np.repeat(rng.uniform(1, 4, 10), 20)
    scores = np.array([np.ones(200), method])
    together, alone = (ratios(scores, [0, 0], commands, NONE) for commands in (np.arange(200) // 20, np.arange(200)))
    wide, narrow = (found["ratio_high"][1] - found["ratio_low"][1] for found in (together, alone))
    assert wide > 3 * narrow


def test_one_row_may_decide_and_gross_errors_can_be_left_out() -> None:
    oracle, method, gross = np.ones(200), np.full(200, 2.0), NONE.copy()
    oracle[7], method[7], gross[7] = 1e6, 1e6, True
    found = ratios(np.array([oracle, method]), [0, 0], np.arange(200), gross)
    assert found["winkler_ratio_to_oracle"][1] == pytest.approx(1.0, abs=1e-3)
    assert found["ratio_without_gross"][1] == pytest.approx(2.0)
    assert found["ratio_high"][1] == pytest.approx(2.0)  # of the draws without that row


def test_each_method_counts_the_rows_that_it_was_given() -> None:
    few, refused = np.full(200, 3.0), np.full(200, np.nan)
    few[:20] = np.nan
    infinite = np.full(200, 2.0)
    infinite[3] = np.inf
    found = ratios(np.array([np.ones(200), few, refused, infinite]), [0] * 4, np.arange(200), NONE)
    np.testing.assert_allclose(found["winkler_ratio_to_oracle"], [1.0, 3.0, np.nan, np.inf])
    assert (found["ratio_low"][1], found["ratio_high"][1]) == (3.0, 3.0)
    assert np.isnan(found["ratio_high"][2])
    assert found["ratio_high"][3] == np.inf
    assert found["ratio_low"][3] == pytest.approx(2.0)
