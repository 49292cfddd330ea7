"""Recalibration on a few labelled poses."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.uncertainty.recalibration import Recalibration, recalibration

MOVING = np.ones(3, dtype=bool)
RNG = np.random.default_rng(0)
KNOWN = RNG.standard_normal((80, 3))


def found(errors: Array, spread: Array | None = None) -> Recalibration:
    return recalibration(KNOWN, errors, MOVING, spread, "arm")


@pytest.mark.parametrize(
    ("n_poses", "scale", "least"),
    [(1, 1.0, 0.88), (5, 1.0, 0.89), (5, 1.2, 0.85), (20, 1.2, 0.86), (50, 1.5, 0.86), (20, 0.6, 0.9)],
)
def test_a_shifted_and_scaled_session_is_covered(n_poses: int, scale: float, least: float) -> None:
    """Mean over 300 sessions at 90 %; what a few poses do not tell of a scale is missing while they are few."""
    covered = []
    for _ in range(300):
        errors = 3.0 + scale * RNG.standard_normal((n_poses + 100, 3))
        now = found(errors[:n_poses])
        half = now.half_widths(KNOWN, [0.9])[0]
        covered.append((np.abs(errors[n_poses:] - now.zero) <= half).mean())
    assert np.mean(covered) > least


def test_a_zero_is_shrunk_by_how_few_poses_there_are() -> None:
    errors = np.full((1, 3), 2.0)
    spread = np.ones(3)
    one, many = found(errors, spread).zero, found(np.repeat(errors, 40, axis=0), spread).zero
    np.testing.assert_allclose(found(errors).zero, 2.0)
    assert (one < 1.5).all()
    assert (one < many).all()
    np.testing.assert_allclose(many, 2.0, rtol=0.05)


def test_more_poses_make_narrower_intervals() -> None:
    widths = [found(KNOWN[:n]).half_widths(KNOWN, [0.8, 0.9]).mean(axis=(1, 2)) for n in (2, 10, 50)]
    assert (np.diff(widths, axis=0) < 0).all()
    assert (np.diff(widths, axis=1) > 0).all()


@pytest.mark.parametrize("n_poses", [0, 51])
def test_too_few_and_too_many_poses_are_refused(n_poses: int) -> None:
    with pytest.raises(DataError, match=f"{n_poses} labelled poses, where 1 to 50 are taken"):
        found(np.zeros((n_poses, 3)))


def test_poses_that_contradict_each_other_are_refused() -> None:
    errors = RNG.standard_normal((10, 3))
    errors[7, 1] += 60.0
    with pytest.raises(DataError, match=r"arm, pose 7 is the farthest off: the labelled poses contradict each other"):
        found(errors)


def test_coordinates_that_never_move_stay() -> None:
    known = np.where([True, True, False], KNOWN, 0.0)
    now = recalibration(known, np.full((5, 3), 4.0), np.array([True, True, False]), None, "arm")
    assert now.zero.tolist() == [4.0, 4.0, 0.0]
    assert now.half_widths(known, [0.9])[0, 0, 2] == 0


def test_the_card_says_what_changed() -> None:
    card = found(np.full((5, 3), 2.0)).card()
    assert "5 labelled poses" in card
    assert "+2.00, +2.00, +2.00 mm" in card
    assert "Coverage is promised" in card
