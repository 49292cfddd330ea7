"""The finger, ideal and on the bench."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import chi2

from softkin.core.samples import Array
from softkin.data.standins.tendon_finger import BENCH_ROD, FRICTIONAL, NOISE_MM, ROD, SPEC, bench_tips, play


def tips(*commands: tuple[float, float]) -> Array:
    return SPEC.poses(np.array(commands), np.random.default_rng(0))


def test_the_more_tension_the_more_bend() -> None:
    rows = tips(*[(tension, 0.0) for tension in np.linspace(0, 40, 6)])
    assert (np.diff(rows[:, 0]) > 1).all()
    assert (np.diff(rows[:, 2]) < 0).all()


def test_antagonists_mirror_each_other() -> None:
    a, left, back, turned = tips((30.0, 12.0), (-30.0, 12.0), (30.0, -12.0), (12.0, 30.0))
    np.testing.assert_allclose(left, a * (-1, 1, 1), atol=1e-6)
    np.testing.assert_allclose(back, a * (1, -1, 1), atol=1e-6)
    np.testing.assert_allclose(turned, a[[1, 0, 2]], atol=1e-6)


def test_unloaded_it_stands_straight() -> None:
    tip = tips((0.0, 0.0))[0]
    assert tip[:2].tolist() == [0.0, 0.0]
    assert 119.5 < tip[2] < ROD.length


def test_play_follows_with_a_lag() -> None:
    out, stops = play(np.array([[100.0], [90.0], [60.0], [20.0], [50.0]]), 20.0)
    assert out.ravel().tolist() == [80.0, 80.0, 80.0, 40.0, 40.0]
    assert stops.ravel().tolist() == [1.0, 0.5, -1.0, -1.0, 0.5]


@settings(max_examples=100, deadline=None)
@given(st.lists(st.floats(-2000, 2000), min_size=1, max_size=20), st.floats(1, 100))
def test_play_stays_within_its_width_and_does_not_depend_on_speed(commands: list[float], half_width: float) -> None:
    """Rate independence: a stop half-way between two commands changes nothing after it."""
    path = np.array([0.0, *commands])[:, None]
    halves = np.empty((2 * len(path) - 1, 1))
    halves[::2], halves[1::2] = path, (path[1:] + path[:-1]) / 2
    out, stops = play(path, half_width)
    assert np.abs(stops).max() <= 1
    assert np.abs(out - path).max() <= half_width * (1 + 1e-9)
    np.testing.assert_allclose(play(halves, half_width)[0][::2], out, atol=1e-8)


def test_the_same_command_reached_from_two_sides_gives_two_poses() -> None:
    above, below = bench_tips(np.array([[1500.0, 0.0], [1000.0, 0.0], [0.0, 0.0], [1000.0, 0.0]]))[[1, 3]]
    assert above[1] - below[1] > 2  # mm, in the direction in which the first command bends
    once_more = bench_tips(np.array([[1500.0, 0.0], [1000.0, 0.0], [1500.0, 0.0], [1000.0, 0.0]]))
    np.testing.assert_allclose(once_more[1], once_more[3], atol=1e-6)


def test_friction_widens_the_loop_beyond_the_backlash(monkeypatch: pytest.MonkeyPatch) -> None:
    def gap() -> float:
        reached = bench_tips(np.array([[1500.0, 0.0], [1000.0, 0.0], [0.0, 0.0], [1000.0, 0.0]]))
        return float(reached[1, 1] - reached[3, 1])

    rubbing = gap()
    monkeypatch.setattr("softkin.data.standins.tendon_finger.BENCH_ROD", replace(BENCH_ROD, friction=0.0))
    backlash_alone = gap()
    assert backlash_alone > 1
    assert rubbing > backlash_alone + 1


def test_the_bench_turns_the_axes() -> None:
    first, second = bench_tips(np.array([[1500.0, 0.0]]))[0], bench_tips(np.array([[0.0, 1500.0]]))[0]
    assert first[1] > 30
    assert second[0] < -30
    np.testing.assert_allclose(second, [-first[1], first[0], first[2]], atol=1e-6)


def test_measurement_noise_has_its_standard_deviation() -> None:
    commands = FRICTIONAL.draw(300, np.random.default_rng(3))
    noise = FRICTIONAL.poses(commands, np.random.default_rng(4)) - bench_tips(commands)
    lowest, highest = chi2.interval(1 - 1e-6, noise.size)
    assert lowest <= float((noise**2).sum()) / NOISE_MM**2 <= highest


def test_commands_stay_in_range() -> None:
    ideal, counts = (robot.draw(400, np.random.default_rng(0)) for robot in (SPEC, FRICTIONAL))
    assert np.abs(ideal).max() <= 40
    assert max(math.hypot(*row) for row in counts) <= 2000
