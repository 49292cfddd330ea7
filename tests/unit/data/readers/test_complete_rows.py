from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.complete_rows import DROP_MARKERS, DROP_ROWS, REFUSE, Whole, lost_markers, whole

NAMES = [f"{marker}_{axis}" for marker in ("base", "tip") for axis in "xyz"]


def robot(n_rows: int = 20) -> tuple[Any, Any]:
    """Commands (n_rows, 1) and positions (n_rows, 6) of two markers that stay away from 0."""
    rng = np.random.default_rng(0)
    return rng.normal(size=(n_rows, 1)), 100.0 + rng.normal(size=(n_rows, 6))


def of(commands: Any, positions: Any, missing: str, unjoined: Any = None, dimensions: int = 3) -> Whole:
    return whole(
        commands,
        positions,
        NAMES,
        dimensions=dimensions,
        missing=missing,
        unjoined=unjoined,
        place=lambda row: f"line {row}",
    )


def test_all_is_kept_of_what_has_no_gaps() -> None:
    for missing in (REFUSE, DROP_ROWS, DROP_MARKERS):
        found = of(*robot(), missing)
        assert found.rows.tolist() == list(range(20))
        assert found.coordinates.tolist() == list(range(6))
    assert of(*robot(), REFUSE).counts == {}
    assert of(*robot(), DROP_ROWS).counts == {"rows_with_gaps": 0}


def test_rows_with_gaps_are_dropped_and_counted() -> None:
    commands, positions = robot()
    commands[3], positions[[5, 6], 1] = np.nan, np.nan
    found = of(commands, positions, DROP_ROWS)
    assert found.rows.tolist() == [row for row in range(20) if row not in (3, 5, 6)]
    assert found.counts == {"rows_with_gaps": 3}


def test_markers_with_gaps_are_dropped_and_counted_but_for_rows_without_any_marker() -> None:
    commands, positions = robot()
    commands[3], positions[[5, 6], 4], positions[9] = np.nan, np.nan, np.nan
    found = of(commands, positions, DROP_MARKERS)
    assert found.rows.tolist() == [row for row in range(20) if row not in (3, 9)]
    assert found.coordinates.tolist() == [0, 1, 2]
    assert found.counts == {
        "rows_with_gaps": 2,
        "markers_with_gaps": [{"columns": ["tip_x", "tip_y", "tip_z"], "rows": 2}],
    }
    positions[7, 0] = np.nan
    with pytest.raises(DataError, match="every marker is lost in some row"):
        of(commands, positions, DROP_MARKERS)


def test_rows_without_a_partner_are_dropped_whatever_is_said_of_gaps() -> None:
    commands, positions = robot()
    unjoined = np.zeros(20, dtype=bool)
    unjoined[[2, 4]] = True
    positions[unjoined] = np.nan
    positions[7] = np.nan
    for missing, gaps in ((REFUSE, {}), (DROP_ROWS, {"rows_with_gaps": 1})):
        kept = positions.copy() if gaps else np.where(np.arange(20)[:, None] == 7, 100.0, positions)
        found = of(commands, kept, missing, unjoined)
        assert found.counts == {"rows_without_partner": 2, **gaps}
        assert len(found.rows) == 18 - len(gaps)
    with pytest.raises(DataError, match="no row has all numbers"):
        of(commands, np.full((20, 6), np.nan), DROP_ROWS)


def test_zeros_of_a_lost_marker_are_gaps() -> None:
    commands, positions = robot()
    positions[[4, 8], 3:] = 0.0
    with pytest.raises(DataError, match=r"line 4, columns tip_x, tip_y, tip_z: .* lost it .*: 2, rows 4, 8"):
        of(commands, positions, REFUSE)
    assert len(of(commands, positions.copy(), DROP_ROWS).rows) == 18
    assert of(commands, positions, DROP_MARKERS).coordinates.tolist() == [0, 1, 2]


def test_zeros_of_a_marker_that_is_there_are_positions() -> None:
    _, positions = robot()
    positions[:, :3] = 0.0  # the base is the origin
    displaced = positions[:, 3:] - positions[0, 3:]  # from the first pose
    assert not lost_markers(np.hstack([positions[:, :3], displaced]), 3).any()
    through = np.column_stack([np.linspace(-50, 50, 21), np.zeros(21)])
    assert not lost_markers(through, 2).any()
    lost = np.where(np.arange(21)[:, None] % 5 == 0, 0.0, through + np.array([0.0, 60.0]))
    assert lost_markers(lost, 2).sum() == 5


def test_a_marker_that_stands_at_the_origin_in_most_rows_is_there() -> None:
    _, positions = robot()
    positions[1:, :3] = 0.0
    assert not lost_markers(positions, 3).any()
