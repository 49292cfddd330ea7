from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from softkin.core.metrics.interval import winkler_scores
from softkin.core.samples import Array
from softkin.uncertainty.labelled.oracle import answer, constant_answer
from softkin.uncertainty.labelled.spec import Answer, Labelled
from tests.unit.uncertainty.conftest import LEVELS, norm, rank
from tests.unit.uncertainty.labelled.conftest import labelled


def test_each_row_is_left_out_of_its_own_calibration() -> None:
    rows = labelled(m=50)
    half_widths = constant_answer(rows, LEVELS, 0).half_widths
    scores = np.abs(rows.errors)
    for place, level in enumerate(LEVELS):
        for row in range(50):
            rest = np.sort(np.delete(scores, row, axis=0), axis=0)
            np.testing.assert_array_equal(half_widths[place, row], rest[rank(49, level) - 1])


def test_too_few_rows_give_infinite_intervals() -> None:
    for method in (answer, constant_answer):
        assert np.isinf(method(labelled(m=10), [0.95], 0).half_widths).all()


def test_calibration_rows_do_not_matter() -> None:
    rows = labelled()
    other = replace(rows, calibration_errors=1e6 * rows.calibration_errors)
    for method in (answer, constant_answer):
        np.testing.assert_array_equal(method(other, LEVELS, 0).half_widths, method(rows, LEVELS, 0).half_widths)


def growing(power: float, m: int = 600) -> tuple[Labelled, Array]:
    """New rows up to twice as far out as `train`, whose errors are normal and grow by a power of the distance; and the
    best half-widths at 90 %.
    """
    rows = labelled(m=m, norms=(1.0, 2.0))
    size = norm(rows.commands)[:, None] ** power
    errors = np.random.default_rng(1).standard_normal(rows.errors.shape) * size
    return replace(rows, errors=errors), np.broadcast_to(1.6449 * size, errors.shape)


def score(rows: Labelled, halves: Array) -> float:
    return float(winkler_scores(rows.errors, np.stack([-halves, halves], axis=-1), 0.9).mean())


@pytest.mark.parametrize("power", [0.0, 2.0, 6.0])
def test_it_is_nearly_as_good_as_the_true_growth_of_errors_allows(power: float) -> None:
    rows, best = growing(power)
    halves = answer(rows, LEVELS, 0).half_widths[LEVELS.index(0.9)]
    assert score(rows, halves) < 1.05 * score(rows, best)
    assert np.mean(np.abs(rows.errors) <= halves) == pytest.approx(0.9, abs=0.02)


def test_where_errors_grow_one_of_constant_width_flatters() -> None:
    rows, best = growing(6.0)
    constant = constant_answer(rows, LEVELS, 0).half_widths[LEVELS.index(0.9)]
    assert score(rows, constant) > 1.3 * score(rows, best)


def test_rows_of_a_command_are_left_out_together() -> None:
    """What one of two copies errs by says nothing of the interval of the other."""
    rows, _ = growing(2.0, m=100)
    twice = replace(rows, commands=np.repeat(rows.commands, 2, axis=0), errors=np.repeat(rows.errors, 2, axis=0))
    changed = replace(twice, errors=twice.errors.copy())
    changed.errors[40] *= 1000.0
    before, after = (result.half_widths for result in map(made, (twice, changed)))
    np.testing.assert_array_equal(before[:, 40:42], after[:, 40:42])


def made(rows: Labelled) -> Answer:
    return answer(rows, LEVELS, 0)
