"""Splits of a recording by time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.recording import CommandMemory, Recording
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, VALIDATION
from softkin.data.split_in_time import split_in_time

N = 300
REST = CommandMemory(np.zeros(0), np.zeros(0))
RNG = np.random.default_rng(0)
ORDER = RNG.permutation(N) + 1
SESSIONS = 1 + (ORDER > 120) + (ORDER > 240)
NORMS = RNG.uniform(size=N)


def recording(session: NDArray[Any] = SESSIONS) -> Recording:
    return Recording(ORDER, np.asarray(session, dtype=np.int64), np.zeros((N, 0)), REST)


def rows_of(method: str, session: NDArray[Any] = SESSIONS, **options: int) -> dict[str, NDArray[Any]]:
    codes = split_in_time({"method": method, **options}, NORMS, recording(session), 0.3)
    return {subset: np.flatnonzero(codes == place) for place, subset in enumerate(SUBSETS)}


@pytest.mark.parametrize("method", ["session", "later"])
def test_the_outer_rows_are_extrapolation(method: str) -> None:
    rows = rows_of(method)
    assert len(rows[EXTRAPOLATION]) == round(0.3 * N)
    assert NORMS[rows[EXTRAPOLATION]].min() > NORMS[rows[TRAIN]].max()


def test_the_last_session_is_the_test() -> None:
    rows = rows_of("session")
    assert set(SESSIONS[rows[TEST]]) == {3}
    assert set(SESSIONS[rows[TRAIN]]) == set(SESSIONS[rows[VALIDATION]]) == {1, 2}
    assert 0.08 < len(rows[VALIDATION]) / (len(rows[TRAIN]) + len(rows[VALIDATION])) < 0.15
    assert rows_of("session", seed=1)[VALIDATION].tolist() != rows[VALIDATION].tolist()


def test_later_rows_are_the_test() -> None:
    rows = rows_of("later")
    assert ORDER[rows[TRAIN]].max() < ORDER[rows[VALIDATION]].min()
    assert ORDER[rows[VALIDATION]].max() < ORDER[rows[TEST]].min()
    assert len(rows[TRAIN]) == round(0.8 * 0.7 * N)


def test_one_session_has_no_next_one() -> None:
    with pytest.raises(DataError, match="one session, so there is no next one"):
        rows_of("session", np.ones(N))


def test_without_a_recording_there_is_no_time() -> None:
    with pytest.raises(DataError, match="`method: later` needs the order in time"):
        split_in_time({"method": "later"}, NORMS, None, 0.3)


def test_an_empty_subset_is_an_error() -> None:
    few = np.array([0.0, 0.1, 0.2])
    known = Recording(np.arange(3), np.ones(3, dtype=np.int64), np.zeros((3, 0)), REST)
    with pytest.raises(DataError, match="validation would be empty"):
        split_in_time({"method": "later"}, few, known, 0.3)
