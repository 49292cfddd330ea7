"""Files as people record them, in tests/cases: each is read, or one sentence says how it can be."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.core.samples import SUBSETS
from softkin.data.readers import READERS, table_file
from softkin.data.readers.table_formats import open_table
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


@pytest.mark.parametrize(
    ("file", "entry"),
    [
        ("11_numpy_savetxt.txt", {}),
        ("12_preamble.csv", {}),
        ("19_units_row.csv", {}),
        ("25_tab_decimal_comma.tsv", {}),
        ("26_pandas_index.csv", {}),
        ("10_no_header.txt", {"header": "none", "commands": ["c1", "c2"], "positions": ["c3", "c4", "c5"]}),
    ],
)
def test_text_in_any_layout_is_read(file: str, entry: dict[str, Any]) -> None:
    rows = rows_of(file, **entry)
    assert rows.shape == (120, 5)
    nearest = np.abs(rows - FIRST).max(axis=1)
    assert nearest.min() < 1e-4


def test_a_file_without_header_says_the_key_that_lets_it_be_read() -> None:
    with pytest.raises(DataError, match="HEADER=none"):
        open_table(CASES / "10_no_header.txt", {})


def test_a_row_of_units_is_known() -> None:
    assert open_table(CASES / "19_units_row.csv", {}).units == ("bar", "bar", "mm", "mm", "mm")


def test_rows_of_a_lost_marker_are_listed_or_dropped_and_counted() -> None:
    positions = {"positions": ["x", "y", "z", "m2_x", "m2_y", "m2_z"]}
    with pytest.raises(DataError, match=r"no value \(rows with such problems: \d+, lines 2, .* more, the last"):
        rows_of("13_occluded_marker.csv", **positions)
    counts: dict[str, int] = {}
    source = {**ENTRY, **NAMED, **positions, "missing": "drop_rows"}
    subsets = table_file.read(CASES / "13_occluded_marker.csv", dataset="arm", source=source, counts=counts)
    assert counts["rows_with_gaps"] == 120 - sum(map(len, subsets.values())) == 11


def test_lists_in_cells_become_columns() -> None:
    table = open_table(CASES / "23_lists_in_cells.csv", {})
    assert table.names == ("index", *(f"{axis}{place}" for axis in "xyz" for place in (1, 2, 3, 4)), "Angle")
    values, _ = table.read([1, 4, 5], [])
    assert values.shape == (30, 3)
    assert values[0].tolist() == [0.1465, 0.7581, 1.0]


def test_arrays_of_numpy_and_structs_of_matlab_are_tables() -> None:
    npz = open_table(CASES / "07_commands_and_positions.npz", {})
    assert npz.names == ("act_list_1", "act_list_2", "positions_x", "positions_y", "positions_z")
    mat = open_table(CASES / "27_struct.mat", {})
    assert mat.names == ("t", "u_1", "u_2", "y_1", "y_2", "y_3")
    for table, first in ((npz, 0), (mat, 1)):
        values, _ = table.read(range(first, first + 5), [])
        assert values.shape == (120, 5)
        np.testing.assert_allclose(values[0], FIRST, atol=1e-4)


def test_ones_own_file_in_the_published_layout_says_its_format() -> None:
    with pytest.raises(DataError, match="kinn_json"):
        open_table(CASES / "08_kinn_layout.json", {})
    entry = {"file": "arm.json", "n_commands": 2, "n_markers": 1}
    subsets = READERS["kinn_json"](CASES / "08_kinn_layout.json", dataset="arm", source=entry)
    assert sum(map(len, subsets.values())) == 120
