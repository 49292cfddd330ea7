from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import DataError
from softkin.core.files import read_json
from softkin.core.rotations import KINDS, from_mean, mean_of, to_numbers
from softkin.core.samples import SUBSETS
from softkin.data.prepare import prepare
from softkin.data.readers import table_file
from softkin.data.table import read_subset
from tests.conftest import bending_arm

ARM = bending_arm(200)
VECTORS = np.column_stack([-ARM.commands[:, 1], ARM.commands[:, 0], 0.1 * ARM.commands[:, 0]])
ENTRY: dict[str, Any] = {"title": "Arm", "format": "table_file", "file": "arm.csv", "position_unit": "mm"}
ENTRY |= {"commands": ["u1", "u2"], "positions": ["x", "y", "z"], "split": {"method": "random"}}


def written(folder: Path, kind: str = "quaternion_xyzw", change: Mapping[str, float] | None = None) -> dict[str, Any]:
    """A file with the orientation in columns o0, o1, ..., and its entry; `change` sets cells of rows 3 and 4."""
    names = [f"o{place}" for place in range(KINDS[kind])]
    numbers = np.hstack([ARM.commands, ARM.positions, to_numbers(VECTORS, kind)])
    table = pd.DataFrame(numbers, columns=["u1", "u2", "x", "y", "z", *names])
    for name, value in (change or {}).items():
        table.loc[[3, 4], name] = value
    table.to_csv(folder / "arm.csv", index=False)
    return {**ENTRY, "orientation": {"kind": kind, "columns": names}}


def read(folder: Path, source: dict[str, Any], counts: dict[str, Any] | None = None) -> dict[str, Any]:
    return table_file.read(folder / "arm.csv", dataset="arm", source=source, counts=counts)


def prepared(folder: Path, source: dict[str, Any]) -> dict[str, Any]:
    table, description = folder / "table.parquet", folder / "dataset.json"
    prepare(folder / "arm.csv", dataset="arm", source=source, table=table, description=description)
    return dict(read_json(description))


@pytest.mark.parametrize("kind", KINDS)
def test_rows_keep_their_orientation_whatever_the_file_writes_of_it(kind: str, tmp_path: Path) -> None:
    for rows in read(tmp_path, written(tmp_path, kind)).values():
        expected = np.column_stack([-rows.commands[:, 1], rows.commands[:, 0], 0.1 * rows.commands[:, 0]])
        np.testing.assert_allclose(rows.orientation, expected, atol=1e-9)
        assert rows.positions.shape[1] == 3


def test_the_table_holds_it_about_the_mean_of_train(tmp_path: Path) -> None:
    source = written(tmp_path)
    raw, said = read(tmp_path, source), prepared(tmp_path, source)["orientation"]
    np.testing.assert_allclose(said["mean_vector"], mean_of(raw["train"].orientation), atol=1e-12)
    assert said["kind"] == "quaternion_xyzw"
    for subset in SUBSETS:
        rows = read_subset(tmp_path / "table.parquet", subset)
        assert rows.orientation is not None
        there = from_mean(rows.orientation, np.array(said["mean_vector"]))
        np.testing.assert_allclose(there, raw[subset].orientation, atol=1e-9)
        np.testing.assert_array_equal(rows.positions, raw[subset].positions)


def test_without_the_key_nothing_is_different(tmp_path: Path) -> None:
    described = prepared(tmp_path, {key: value for key, value in written(tmp_path).items() if key != "orientation"})
    assert read_subset(tmp_path / "table.parquet", "train").orientation is None
    assert "orientation" not in described
    hashes = described["content_sha256"]
    assert prepared(tmp_path, written(tmp_path))["content_sha256"] != hashes


def test_rows_of_a_body_that_was_lost_are_left_out_where_the_entry_says_so(tmp_path: Path) -> None:
    for lost in (np.nan, 0.0):
        source = written(tmp_path, change=dict.fromkeys(["o0", "o1", "o2", "o3"], lost))
        with pytest.raises(DataError, match=r"no value|no quaternion: its norm is 0, not 1 within 0.02 .in 2 of 200"):
            read(tmp_path, source)
        counts: dict[str, Any] = {}
        read(tmp_path, source | {"missing": "drop_rows"}, counts)
        assert counts == {"rows_with_gaps": 2}


def test_a_tip_that_turns_half_around_is_warned_of(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    wrong = written(tmp_path, "roll_pitch_yaw_degrees")
    prepared(tmp_path, wrong)
    assert "turned by more than" not in caplog.text
    wrong["orientation"]["kind"] = "roll_pitch_yaw_radians"
    prepared(tmp_path, wrong)
    assert "turned by more than 150 degrees from their mean" in caplog.text


def test_a_column_has_one_role(tmp_path: Path) -> None:
    source = written(tmp_path)
    with pytest.raises(DataError, match="'o0' stands in `commands`"):
        read(tmp_path, source | {"commands": ["u1", "u2", "o0"]})
