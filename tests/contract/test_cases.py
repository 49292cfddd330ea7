"""Files as people record them, in tests/cases: each is read, or one sentence says how it can be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.core.samples import SUBSETS
from softkin.data.readers import READERS, table_file
from softkin.data.readers.table_formats import open_table
from softkin.data.retrieve import take_own_files
from tests.conftest import HOUSE

CASES = HOUSE / "tests" / "cases"
#: The first row of most of the files.
FIRST = [0.2502, 0.7944, 12.8626, 40.9234, 108.6385]
ENTRY: dict[str, Any] = {"file": "arm", "position_unit": "mm", "split": {"method": "random"}}
NAMED: dict[str, Any] = {"commands": ["u1", "u2"], "positions": ["x", "y", "z"]}


def rows_of(file: str, **entry: Any) -> Any:
    """The rows of all subsets as they are read with an entry."""
    subsets = table_file.read(CASES / file, dataset="arm", source={**ENTRY, **NAMED, **entry})
    assert list(subsets) == list(SUBSETS)
    return np.vstack([np.hstack([rows.commands, rows.positions]) for rows in subsets.values()])


def is_whole(rows: Any) -> bool:
    """Whether these are the 120 rows that most of the files hold."""
    assert rows.shape == (120, 5)
    return bool(np.abs(rows - FIRST).max(axis=1).min() < 1e-4)


def test_10_no_header_is_read_by_the_key_that_its_message_names() -> None:
    with pytest.raises(DataError, match="header: none"):
        rows_of("10_no_header.txt")
    assert is_whole(rows_of("10_no_header.txt", header="none", commands=["c1", "c2"], positions=["c3", "c4", "c5"]))


def test_11_names_in_a_comment_and_columns_split_by_blanks_are_read() -> None:
    assert is_whole(rows_of("11_numpy_savetxt.txt"))


def test_12_lines_above_the_header_are_no_part_of_it() -> None:
    assert is_whole(rows_of("12_preamble.csv"))


def test_15_commands_and_positions_in_two_files_are_joined_by_a_column(tmp_path: Path) -> None:
    files = ["15a_commands.csv", "15b_positions.csv"]
    entry = {"files": [str(CASES / name) for name in files], "join": {"by": "column", "column": "ID"}}
    take_own_files(dataset="arm", entry=entry, destination=tmp_path / "raw")
    source = {**ENTRY, **NAMED, **entry}
    counts: dict[str, Any] = {}
    subsets = table_file.read(tmp_path / "raw", dataset="arm", source=source, counts=counts)
    assert is_whole(np.vstack([np.hstack([rows.commands, rows.positions]) for rows in subsets.values()]))
    assert counts == {"rows_without_partner": 0}


def test_19_a_row_of_units_is_known_and_is_no_pose() -> None:
    assert is_whole(rows_of("19_units_row.csv"))
    assert open_table(CASES / "19_units_row.csv", {}).units == ("bar", "bar", "mm", "mm", "mm")


def test_25_tabs_and_decimal_commas_are_read() -> None:
    assert is_whole(rows_of("25_tab_decimal_comma.tsv"))


def test_26_the_nameless_column_of_pandas_is_no_command() -> None:
    assert is_whole(rows_of("26_pandas_index.csv"))


def test_06_an_export_of_motive_tells_names_unit_and_gaps() -> None:
    table = open_table(CASES / "06_motive_export.csv", {})
    assert table.names[1:3] == ("Time (Seconds)", "arm:Marker1_x")
    assert set(table.units[2:]) == {"mm"}
    positions = {"commands": ["Frame"], "positions": [f"arm:Marker{n}_{axis}" for n in (1, 2) for axis in "xyz"]}
    with pytest.raises(DataError, match=r"(?s)rows with such problems: 7, lines 11, .*drop_rows"):
        rows_of("06_motive_export.csv", **positions)
    assert rows_of("06_motive_export.csv", **positions, missing="drop_rows").shape == (113, 7)
    assert rows_of("06_motive_export.csv", **positions, missing="drop_markers").shape == (120, 4)


@pytest.mark.parametrize(
    ("missing", "n_rows", "n_coordinates", "counted"),
    [
        ("drop_rows", 109, 6, {"rows_with_gaps": 11}),
        (
            "drop_markers",
            120,
            3,
            {"rows_with_gaps": 0, "markers_with_gaps": [{"columns": ["m2_x", "m2_y", "m2_z"], "rows": 11}]},
        ),
    ],
)
def test_13_rows_of_a_lost_marker_are_listed_or_left_out_and_counted(
    missing: str, n_rows: int, n_coordinates: int, counted: dict[str, Any]
) -> None:
    file, positions = "13_occluded_marker.csv", ["x", "y", "z", "m2_x", "m2_y", "m2_z"]
    with pytest.raises(DataError, match=r"no value \(rows with such problems: 11, lines 2, .* and 1 more, the last"):
        rows_of(file, positions=positions)
    counts: dict[str, Any] = {}
    source = {**ENTRY, **NAMED, "positions": positions, "missing": missing}
    subsets = table_file.read(CASES / file, dataset="arm", source=source, counts=counts)
    assert counts == counted
    assert sum(map(len, subsets.values())) == n_rows
    assert subsets["train"].positions.shape[1] == n_coordinates


def test_23_lists_in_cells_become_columns() -> None:
    table = open_table(CASES / "23_lists_in_cells.csv", {})
    assert table.names == ("index", *(f"{axis}{place}" for axis in "xyz" for place in (1, 2, 3, 4)), "Angle")
    values, _ = table.read([1, 4, 5], [])
    assert values.shape == (30, 3)
    assert values[0].tolist() == [0.1465, 0.7581, 1.0]


def test_07_arrays_of_numpy_are_a_table() -> None:
    table = open_table(CASES / "07_commands_and_positions.npz", {})
    assert table.names == ("act_list_1", "act_list_2", "positions_x", "positions_y", "positions_z")
    assert is_whole(table.read(range(5), [])[0])


def test_27_trials_of_a_struct_of_matlab_are_sessions() -> None:
    table = open_table(CASES / "27_struct.mat", {})
    assert table.names[-6:] == ("t", "u_1", "u_2", "y_1", "y_2", "y_3")
    place = table.names.index("u_1")
    assert is_whole(table.read(range(place, place + 5), [])[0])


def test_08_ones_own_file_in_the_published_layout_says_its_format() -> None:
    with pytest.raises(DataError, match="kinn_json"):
        open_table(CASES / "08_kinn_layout.json", {})
    entry = {"file": "arm.json", "n_commands": 2, "n_markers": 1}
    subsets = READERS["kinn_json"](CASES / "08_kinn_layout.json", dataset="arm", source=entry)
    assert sum(map(len, subsets.values())) == 120
