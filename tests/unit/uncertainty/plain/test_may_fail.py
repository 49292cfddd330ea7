from __future__ import annotations

import warnings

import numpy as np

from softkin.uncertainty.plain.may_fail import MayFail
from tests.exported_robots import NEW, failing

LEVELS = [0.5, 0.9, 0.9999999]


def test_it_answers_as_the_class_of_failures() -> None:
    known = failing().failures
    assert known is not None
    plain, bounds = MayFail(known.numbers(LEVELS)), np.stack([np.full((80, 6), -1.0), np.full((80, 6), 1.0)], axis=-1)
    np.testing.assert_array_equal(plain.probability(NEW), known.probability(NEW))
    for place, flagged in enumerate(known.may_fail(NEW, LEVELS)):
        np.testing.assert_array_equal(plain.at(NEW, place), flagged)
        assert flagged.any()
        widened = known.widened(bounds[None], NEW, [LEVELS[place]])[0]
        np.testing.assert_array_equal(plain.widened(bounds, NEW, place), widened)


def test_a_command_that_32_bits_do_not_hold_is_answered_without_a_warning() -> None:
    known = failing().failures
    assert known is not None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        far = MayFail(known.numbers(LEVELS)).probability(np.array([[1e60, 0.0], [1e9, 0.0]]))
    assert far[0] == far[1]
