from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.core.errors import DataError
from softkin.data.readers.partner_rows import Partners, by_column, by_time, check_some, seconds

NAMES = ("own.csv", "other.csv")
TIMES = arrays(float, st.integers(1, 12), elements=st.floats(0, 10, width=16))


def texts(*values: str) -> Any:
    return np.array(values, dtype=object)


@pytest.mark.parametrize(
    ("own", "other", "rows"),
    [
        (texts("2", "0", "5"), texts("0", "1", "2"), [2, 0, -1]),
        (texts("2.0", "00", "5"), np.array([0.0, 1.0, 2.0]), [2, 0, -1]),
        (texts(" b", "a", "a"), texts("a ", "b"), [1, 0, 0]),
        (texts("a", "1"), np.array([1, 2]), [-1, 0]),
        (texts("1", "", "2"), texts("1.0", "2.0", "", " "), [0, -1, 1]),
        (np.array([np.nan, 1.0]), np.array([np.nan, 2.0, np.nan, 1.0]), [-1, 3]),
        (texts("", ""), texts("1"), [-1, -1]),
    ],
)
def test_equal_values_are_partners_as_numbers_or_as_text(own: Any, other: Any, rows: list[int]) -> None:
    assert by_column(own, other, NAMES).rows.tolist() == rows


def test_a_value_twice_in_the_other_file_is_an_error() -> None:
    with pytest.raises(DataError, match=r"other.csv.*1 values stand in several rows of it, the first: 1"):
        by_column(texts("1"), texts("1", "2", "1"), NAMES)


@given(own=TIMES, other=TIMES, tolerance=st.floats(0.01, 3))
def test_partners_in_time_are_those_of_the_definition(own: Any, other: Any, tolerance: float) -> None:
    values = np.arange(float(len(other)))[:, None]
    nearest, hold, mean = (by_time(own, other, tolerance, rule) for rule in ("nearest", "hold", "mean"))
    for row, time in enumerate(own):
        distance = np.abs(other - time)
        assert (nearest.rows[row] >= 0) == (distance.min() <= tolerance)
        if nearest.rows[row] >= 0:
            assert distance[nearest.rows[row]] == distance.min()
        before = other[other <= time]
        is_held = before.size > 0 and time - before.max() <= tolerance
        assert (hold.rows[row] >= 0) == is_held
        if is_held:
            assert other[hold.rows[row]] == before.max()
        near = (other >= time - tolerance) & (other <= time + tolerance)
        found = mean.numbers(values)[row, 0]
        assert np.isnan(found) == (not near.any())
        if near.any():
            assert found == pytest.approx(values[near, 0].mean())


def test_means_leave_gaps_out() -> None:
    partners = by_time(np.array([0.0, 10.0]), np.array([-0.1, 0.0, 0.1, 10.0]), 0.5, "mean")
    values = np.array([[1.0, 5.0], [np.nan, 7.0], [3.0, np.nan], [np.nan, 1e9]])
    np.testing.assert_allclose(partners.numbers(values), [[2.0, 6.0], [np.nan, 1e9]])


def test_values_without_partner_are_gaps() -> None:
    partners = Partners(np.array([1, -1]))
    np.testing.assert_array_equal(partners.numbers(np.array([[1.0], [2.0]])), [[2.0], [np.nan]])
    assert partners.others(texts("a", "b")).tolist() == ["b", None]
    np.testing.assert_array_equal(partners.others(np.array([3, 4])), [4.0, np.nan])


def test_dates_are_seconds_and_numbers_stay() -> None:
    dates = texts("2024-05-31T12:00:00.5", "2024-05-31T12:00:02")
    assert np.diff(seconds("t", dates, str)).tolist() == [1.5]
    assert seconds("t", texts("0,5", "2"), str).tolist() == [0.5, 2.0]
    assert seconds("t", np.array([1, 2]), str).tolist() == [1.0, 2.0]


def test_no_partner_at_all_says_what_both_files_hold() -> None:
    names = {"own": "own.csv", "other": "other.csv", "column": "time"}
    with pytest.raises(DataError, match=r"its time runs from 0.0 to 1.0, that of the other from 7.0 to 8.0"):
        check_some(Partners(np.array([-1, -1])), np.array([0.0, 1.0]), np.array([7.0, 8.0]), names)
    with pytest.raises(DataError, match=r"its time runs nowhere: it is empty, that of the other from 7 to 8"):
        check_some(
            Partners(np.array([-1])), np.array([None], dtype=object), np.array([7, None, 8], dtype=object), names
        )
