from __future__ import annotations

from dataclasses import replace

import numpy as np

from softkin.uncertainty.labelled.oracle import answer
from tests.unit.uncertainty.conftest import LEVELS, rank
from tests.unit.uncertainty.labelled.conftest import labelled


def test_each_row_is_left_out_of_its_own_calibration() -> None:
    rows = labelled(m=50)
    half_widths = answer(rows, LEVELS, 0).half_widths
    scores = np.abs(rows.errors)
    for place, level in enumerate(LEVELS):
        for row in range(50):
            rest = np.sort(np.delete(scores, row, axis=0), axis=0)
            np.testing.assert_array_equal(half_widths[place, row], rest[rank(49, level) - 1])


def test_too_few_rows_give_infinite_intervals() -> None:
    assert np.isinf(answer(labelled(m=10), [0.95], 0).half_widths).all()


def test_calibration_rows_do_not_matter() -> None:
    rows = labelled()
    other = replace(rows, calibration_errors=1e6 * rows.calibration_errors)
    np.testing.assert_array_equal(answer(other, LEVELS, 0).half_widths, answer(rows, LEVELS, 0).half_widths)
