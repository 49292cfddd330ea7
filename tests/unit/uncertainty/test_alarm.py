"""The alarm: its false alarms, and how soon it notices."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.alarm import Watch
from softkin.uncertainty.promise import Promise

NAMES = ("x", "y", "z")


def test_false_alarms_are_as_rare_as_villes_inequality_says() -> None:
    """100 watches over 60 poses like those calibrated on, at a rate of 10 %: 99 % of runs have at most 18 alarms."""
    alarms = 0
    for seed in range(100):
        errors = np.random.default_rng(seed).standard_t(3, (120, 3))
        watch = Watch(errors[:60], NAMES, rate=0.1, seed=seed)
        for error in errors[60:]:
            watch.judge(error)
        alarms += watch.alarm is not None
    assert alarms <= 18


@pytest.mark.parametrize("seed", range(5))
def test_a_shift_of_1_mm_is_noticed_within_15_poses(seed: int) -> None:
    rng = np.random.default_rng(seed)
    known, new = 0.4 * rng.standard_normal((70, 3)), 0.4 * rng.standard_normal((60, 3))
    new[30:, 1] += 1.0
    watch = Watch(known, NAMES, rate=0.01, seed=seed)
    alarm = next(found for error in new if (found := watch.judge(error)) is not None)
    assert 30 < alarm.pose <= 45
    assert alarm.coordinates == ("y",)
    assert alarm.martingale >= 100
    assert watch.judge(new[-1]) == alarm


def test_a_watch_asks_for_the_error_of_each_pose_in_turn() -> None:
    asked = []

    def error(command: np.ndarray, position: np.ndarray) -> np.ndarray:
        asked.append(command.tolist())
        return np.asarray(position - command.sum())

    watch = Watch(np.zeros((5, 1)), ["x"], error=error)
    assert watch.see(np.array([1, 2]), np.array([3.0])) is None
    assert asked == [[1.0, 2.0]]
    assert watch.p_values.shape == (1, 1)


def test_it_is_the_martingale_of_crepes() -> None:
    from crepes.martingales import SimpleJumper, StepBettingFunction

    errors = np.random.default_rng(0).standard_normal((90, 1))
    errors[60:] += 1.5
    watch = Watch(errors[:30], ["x"], rate=0.05)
    for error in errors[30:]:
        watch.judge(error)
    grown = SimpleJumper(bf=StepBettingFunction()).apply(watch.p_values[:, 0])
    assert watch.alarm is not None
    assert watch.alarm.pose == 1 + int(np.argmax(grown >= 20))
    assert watch.alarm.martingale == pytest.approx(grown[watch.alarm.pose - 1])


def test_of_blocks_the_rate_is_no_guarantee_and_the_watch_says_so() -> None:
    """30 watches of a new block of 20 poses that are alike, at a rate of 10 %: far more false alarms than that."""
    promise, alarms = Promise(20, 20), 0
    for seed in range(30):
        rng = np.random.default_rng(seed)
        errors = np.repeat(rng.standard_normal((21, 1)), 20, axis=0) + 0.3 * rng.standard_normal((420, 1))
        watch = Watch(errors[:400], ["x"], rate=0.1, seed=seed, promise=promise)
        for error in errors[400:]:
            watch.judge(error)
        alarms += watch.alarm is not None
    assert alarms > 9
    assert "no guarantee" in watch.worth
    assert Watch(errors, ["x"]).worth == ""
