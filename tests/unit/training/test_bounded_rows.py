from __future__ import annotations

import numpy as np
import pytest

from softkin.training.bounded_rows import some_rows
from tests.conftest import bending_arm


def test_a_model_that_cannot_take_all_rows_gets_some_and_the_log_says_so(caplog: pytest.LogCaptureFixture) -> None:
    rows = bending_arm(50)
    kept = some_rows(rows, 20, seed=0)
    assert len(kept) == 20
    places = [int(np.flatnonzero((rows.commands == row).all(axis=1))[0]) for row in kept.commands]
    assert places == sorted(set(places))
    np.testing.assert_array_equal(rows.positions[places], kept.positions)
    assert "fitted on 20 of 50 rows: max_fit_rows" in caplog.text
    some_rows(rows, 20, 0, "shells.max_rows")
    assert "fitted on 20 of 50 rows: shells.max_rows" in caplog.text
    caplog.clear()
    assert some_rows(rows, 50, seed=0) is rows is some_rows(rows, None, seed=0)
    assert not caplog.text
