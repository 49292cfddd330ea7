from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.motive_export import open_table
from softkin.data.readers.table_formats import open_table as open_any
from tests.conftest import HOUSE


def test_names_unit_and_gaps_of_an_export_are_read() -> None:
    table = open_table(HOUSE / "tests" / "cases" / "06_motive_export.csv", {})
    markers = [f"arm:Marker{marker}_{axis}" for marker in (1, 2) for axis in "xyz"]
    assert table.names == ("Frame", "Time (Seconds)", *markers)
    assert table.units[2:] == ("mm",) * 6
    values, _ = table.read(range(2, 8), [], gaps=True)
    assert values.shape == (120, 6)
    assert values[0].tolist() == [6.431284, 20.461680, 54.319237, 12.862568, 40.923361, 108.638474]


def test_an_export_without_its_header_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "take.csv").write_text("Format Version,1.23\nFrame,Time\n0,0\n")
    with pytest.raises(DataError, match="without its rows of names"):
        open_table(tmp_path / "take.csv", {})


def test_columns_of_a_rigid_body_are_named_by_what_they_are(tmp_path: Path) -> None:
    kinds = ["Rotation"] * 4 + ["Position"] * 3 + ["Mean Marker Error"]
    rows = [
        "Format Version,1.23,Length Units,Meters",
        "",
        ",Type," + ",".join(["Rigid Body"] * 8),
        ",Name," + ",".join(["tip"] * 8),
        ",," + ",".join(kinds),
        "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,",
        "0,0.0,0,0,0,1,0.1,0.2,0.3,0.0001",
    ]
    (tmp_path / "take.csv").write_text("\n".join(rows) + "\n")
    turned = tuple(f"tip_rotation_{axis}" for axis in "xyzw")
    assert open_table(tmp_path / "take.csv", {}).names[2:] == (
        *turned,
        "tip_x",
        "tip_y",
        "tip_z",
        "tip_Mean Marker Error",
    )


@pytest.mark.parametrize(
    ("delimiter", "mark", "encoding"), [(";", ",", "utf-8"), ("\t", ".", "utf-16"), (";", ".", "utf-8-sig")]
)
def test_an_export_that_was_saved_again_is_read(tmp_path: Path, delimiter: str, mark: str, encoding: str) -> None:
    text = (HOUSE / "tests" / "cases" / "06_motive_export.csv").read_text().replace(".", "@")
    (tmp_path / "take").write_bytes(text.replace(",", delimiter).replace("@", mark).encode(encoding))
    table = open_any(tmp_path / "take", {})
    assert table.names[2:5] == ("arm:Marker1_x", "arm:Marker1_y", "arm:Marker1_z")
    assert table.read(range(2, 5), [], gaps=True)[0][0].tolist() == [6.431284, 20.461680, 54.319237]
