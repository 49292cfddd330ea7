from __future__ import annotations

import logging
from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.named_arrays import table_of_arrays, table_of_variables


def test_axes_beyond_the_first_are_columns() -> None:
    arrays = {"u": np.ones((4, 1, 2)), "position": np.ones((4, 2, 3)), "t": np.arange(4), "rate": np.array(50.0)}
    table = table_of_arrays(arrays)
    markers = [f"position{marker}_{axis}" for marker in (1, 2) for axis in "xyz"]
    assert table.names == ("u_1", "u_2", *markers, "t")
    assert table.read([len(table.names) - 1], [])[0].ravel().tolist() == [0, 1, 2, 3]


def test_arrays_without_rows_are_listed_with_their_shapes() -> None:
    with pytest.raises(DataError, match=r"rate \(\)"):
        table_of_arrays({"rate": np.array(50.0)})


def test_what_is_left_out_is_said(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, "softkin"):
        table_of_arrays({"u": np.ones((4, 2)), "x": np.ones((4, 3)), "gains": np.ones(3)})
    assert "arrays of 4 rows are read; left out: gains (3,)" in caplog.text


def test_several_structs_of_the_same_fields_are_trials_and_others_keep_their_names() -> None:
    trials = {"down": {"u": np.zeros(2), "x": np.ones(2)}, "up": {"x": np.ones(3), "u": np.ones(3)}}
    table = table_of_variables(trials)
    assert table.names == ("session", "u", "x")
    assert table.read([0, 1], [])[0].T.tolist() == [[1, 1, 2, 2, 2], [0, 0, 1, 1, 1]]
    table = table_of_variables({"arm": {"t": np.arange(3), "u": np.ones(3)}, "tip": {"t": np.arange(3)}})
    assert table.names == ("t", "u", "tip_t")
    with pytest.raises(DataError, match="trials have different fields"):
        table_of_variables({"runs": [{"u": np.ones(2)}, {"v": np.ones(2)}]})


U, X = np.arange(40.0).reshape(20, 2), np.arange(60.0).reshape(20, 3)
LOG = np.zeros(20, dtype=[("u", float, 2), ("x", float, 3)])
LOG["u"], LOG["x"] = U, X


@pytest.mark.parametrize(
    "variables",
    [
        {"u": U.T, "x": X.T},
        {"log": LOG},
        {"exp": {"about": {"date": "today"}, "data": {"u": U, "x": X}}},
        {"exp": {"rate": 50.0, "data": {"u": U.T, "x": X}}},
    ],
)
def test_rows_are_found_however_they_are_stored(variables: dict[str, Any]) -> None:
    table = table_of_variables(variables)
    assert table.names == ("u_1", "u_2", "x_1", "x_2", "x_3")
    np.testing.assert_array_equal(table.read(range(5), [])[0], np.hstack([U, X]))


def test_arrays_of_trials_by_rows_are_sessions_and_test_sets_are_not_left_out_silently(
    caplog: pytest.LogCaptureFixture,
) -> None:
    table = table_of_arrays({"u": U.reshape(2, 10, 2), "x": X.reshape(2, 10, 3)})
    assert table.names == ("session", "u_1", "u_2", "x_1", "x_2", "x_3")
    values, (session,) = table.read(range(1, 6), [0])
    np.testing.assert_array_equal(values, np.hstack([U, X]))
    assert session.tolist() == [1] * 10 + [2] * 10
    with caplog.at_level("WARNING"):
        table_of_arrays({"u": U, "x": X, "u_test": U[:5], "x_test": X[:5]})
    assert "left out: u_test (5, 2), x_test (5, 3)" in caplog.text
