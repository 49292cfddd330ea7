from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.core.samples import SUBSETS, TRAIN, Array, Samples
from softkin.data.audit.swapped_markers import check
from softkin.data.marker_order import relabelled
from softkin.data.readers import table_file
from tests.conftest import HOUSE
from tests.unit.data.audit.clean_robot import clean_robot


def exchanged(positions: Array, *order: int) -> Array:
    return np.asarray(positions.reshape(len(positions), -1, 3)[:, list(order)].reshape(len(positions), -1))


@pytest.fixture(scope="module")
def arm() -> dict[str, Samples]:
    return clean_robot(300, n_commands=2, n_markers=4, seed=1)


def test_a_clean_robot_has_no_swapped_markers(arm: dict[str, Samples]) -> None:
    assert check(arm).findings == ()
    assert set(check(arm).numbers["rows"].values()) == {0}


def test_swapped_rows_are_named_and_mended(arm: dict[str, Samples]) -> None:
    swapped = {}
    for name, rows in arm.items():
        positions = rows.positions.copy()
        positions[::4] = exchanged(positions[::4], 1, 0, 2, 3)
        positions[1::40] = exchanged(positions[1::40], 2, 0, 1, 3)
        swapped[name] = Samples(rows.commands, positions, rows.recording)
    result = check(swapped)
    (finding,) = result.findings
    n_train = len(arm[TRAIN])
    expected = sorted({*range(0, n_train, 4), *range(1, n_train, 40)})
    assert finding.rows[TRAIN] == tuple(expected[:100])
    assert finding.subsets == SUBSETS
    mended, counts = relabelled(swapped)
    assert counts == result.numbers["rows"]
    for name, rows in arm.items():
        np.testing.assert_array_equal(mended[name].positions, rows.positions)
    assert check(mended).findings == ()


def test_two_markers_tell_nothing(robot: dict[str, Samples]) -> None:
    assert "not_measured" in check(robot).numbers


def test_case_29_swapped_rows_are_named_and_mended() -> None:
    names = [f"{axis}{place}" for place in (1, 2, 3) for axis in "xyz"]
    entry: dict[str, Any] = {"file": "29", "position_unit": "mm", "commands": ["u1", "u2"], "positions": names}
    entry |= {"split": {"method": "random"}}
    path = HOUSE / "tests" / "cases" / "29_swapped_marker_labels.csv"
    samples = table_file.read(path, dataset="arm", source=entry)
    (finding,) = check(samples).findings
    assert finding.code == "swapped_markers"
    assert 0.25 < sum(finding.n_rows.values()) / 150 < 0.45
    mended, counts = relabelled(samples)
    assert sum(counts.values()) == sum(finding.n_rows.values())
    assert check(mended).findings == ()
    heights = np.concatenate([rows.positions[:, [2, 5]] for rows in mended.values()])
    assert len({first < second for first, second in heights.tolist()}) == 1
