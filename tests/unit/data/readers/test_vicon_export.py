from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import open_table

TRAJECTORIES = """Trajectories
100
,,arm:base,,,arm:tip,,
Frame,Sub Frame,X,Y,Z,X,Y,Z
,,mm,mm,mm,mm,mm,mm
1,0,1,2,3,4,5,6
2,0,1.5,2.5,3.5,,,
"""
DEVICES = """Devices
1000
,,Imaginary - pressure
Frame,Sub Frame,p1
,,V
1,0,0.5

"""


@pytest.mark.parametrize("delimiter", [",", "\t", ";"])
@pytest.mark.parametrize(("before", "after"), [("", ""), (DEVICES, ""), ("\n\n", "\n" + DEVICES)])
def test_names_rate_unit_and_gaps_of_trajectories_are_read(
    tmp_path: Path, before: str, after: str, delimiter: str
) -> None:
    (tmp_path / "take.csv").write_text((before + TRAJECTORIES + after).replace(",", delimiter), newline="\r\n")
    table = open_table(tmp_path / "take.csv", {})
    markers = [f"arm:{marker}_{axis}" for marker in ("base", "tip") for axis in "xyz"]
    assert table.names == ("Frame", "time", "Sub Frame", *markers)
    assert table.units[3:] == ("mm",) * 6
    values, _ = table.read([1, *range(3, 9)], [], gaps=True)
    np.testing.assert_array_equal(values, [[0, 1, 2, 3, 4, 5, 6], [0.01, 1.5, 2.5, 3.5, np.nan, np.nan, np.nan]])
    assert table.place(1) == f"line {before.count(chr(10)) + 7}"


def test_bodies_have_positions_and_orientations(tmp_path: Path) -> None:
    text = "Objects\n100\n,,tip:tip,,,,,\nFrame,Sub Frame,RX,RY,RZ,TX,TY,TZ\n,,deg,deg,deg,mm,mm,mm\n1,0,1,2,3,4,5,6\n"
    (tmp_path / "take.csv").write_text(text)
    names = [f"tip:tip_{kind}{axis}" for kind in ("rotation_", "") for axis in "xyz"]
    assert list(open_table(tmp_path / "take.csv", {}).names[3:]) == names


@pytest.mark.parametrize("text", [DEVICES, "Trajectories\n100\n,,arm:tip\n1,0,3\n"])
def test_an_export_without_trajectories_or_header_is_an_error(tmp_path: Path, text: str) -> None:
    (tmp_path / "take.csv").write_text(text)
    with pytest.raises(DataError, match="an export of Vicon"):
        open_table(tmp_path / "take.csv", {})
