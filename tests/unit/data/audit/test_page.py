from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest

from softkin.core.files import read_json
from softkin.core.samples import SUBSETS
from softkin.data.audit.data_card import audit
from softkin.data.audit.findings import LEAK, NOTE, WARNING, Finding
from softkin.data.audit.page import MAX_COLUMNS_SHOWN, page
from softkin.data.table import to_table, write_table
from tests.unit.data.audit.clean_robot import clean_robot


@pytest.fixture(scope="module")
def written_card(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder: Path = tmp_path_factory.mktemp("card")
    write_table(to_table(clean_robot(300, n_commands=2, n_markers=1, seed=1)), folder / "table.parquet")
    table, data_card, readable = folder / "table.parquet", folder / "card.json", folder / "card.md"
    audit(table, dataset="arm", title="Arm", position_unit="cm", data_card=data_card, readable=readable)
    card: dict[str, Any] = read_json(data_card)
    assert page(card) == readable.read_text(encoding="utf-8")
    return card


@pytest.fixture
def card(written_card: dict[str, Any]) -> dict[str, Any]:
    return copy.deepcopy(written_card)


def table_rows(text: str, heading: str) -> list[list[str]]:
    """Cells of the table under a heading, without its header."""
    section = text.split(f"## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def test_the_page_names_its_dataset_and_units(card: dict[str, Any]) -> None:
    text = page(card)
    assert text.startswith("# Data card: Arm\n\n`arm`. ")
    assert "positions in mm (the file has cm)" in text
    assert text.endswith("\n")
    assert "\n\n\n" not in text


@pytest.mark.parametrize(
    ("severity", "says"), [(LEAK, "**Leak.**"), (WARNING, "**With care.**"), (NOTE, "**Sound.**"), (None, "**Sound.**")]
)
def test_the_verdict_is_that_of_the_worst_finding(card: dict[str, Any], severity: str | None, says: str) -> None:
    card["worst_severity"] = severity
    assert says in page(card)


def test_every_subset_has_its_row_in_the_tables(card: dict[str, Any]) -> None:
    text = page(card)
    rows = table_rows(text, "The rows")
    assert [row[:2] for row in rows] == [[name, str(card["subsets"][name]["rows"])] for name in SUBSETS]
    assert [row[0] for row in table_rows(text, "How near the other subsets come to train")] == list(SUBSETS[1:])
    shift = table_rows(text, "How far they lie from train")
    assert [row[0] for row in shift] == list(SUBSETS)
    assert all(len(row) == 5 for row in shift)


def test_ranges_are_those_of_the_card(card: dict[str, Any]) -> None:
    card["subsets"]["test"]["positions_mm"]["m1_y"] = [-1.5, 12.0]
    rows = {row[0]: row[1:] for row in table_rows(page(card), "Ranges")}
    assert list(rows) == ["u1", "u2", "m1_x", "m1_y", "m1_z"]
    assert rows["m1_y"][SUBSETS.index("test")] == "-1.5 to 12"


def test_of_many_columns_the_first_are_shown_and_the_rest_counted(card: dict[str, Any]) -> None:
    for subset in SUBSETS:
        card["subsets"][subset]["commands"] = {f"u{i}": [0.0, 1.0] for i in range(30)}
    text = page(card)
    assert len(table_rows(text, "Ranges")) == MAX_COLUMNS_SHOWN
    assert f"{33 - MAX_COLUMNS_SHOWN} more columns are in the JSON file." in text


def test_a_finding_lists_its_first_rows(card: dict[str, Any]) -> None:
    rows = {"train": tuple(range(11)), "test": (4,)}
    finding = Finding("stuck", WARNING, ("train", "test"), "Stuck.", "Beware.", rows, {"train": 11, "test": 1})
    card["findings"] = [finding.as_dict()]
    text = page(card)
    assert "- **warning**, `stuck`: Stuck. *Beware.*" in text
    assert "train, 11 rows (numbered from 0): 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, ...\n" in text
    assert "test, 1 row (numbered from 0): 4\n" in text


def test_what_was_not_measured_is_said_with_its_reason(card: dict[str, Any]) -> None:
    card["base"] = {"not_measured": "no marker moves"}
    card["checks"]["near_copies"] = {"not_measured": "too few commands"}
    card["checks"]["gross_outliers"] = {"not_measured": "too few rows"}
    card["checks"]["subset_shift"]["test"]["auc"] = None
    text = page(card)
    for reason in ("no marker moves", "too few commands", "too few rows"):
        assert f"Not measured: {reason}." in text
    assert table_rows(text, "How far they lie from train")[SUBSETS.index("test")][3] == "too few rows"


def test_rows_that_were_dropped_are_counted(card: dict[str, Any]) -> None:
    assert "`clean`" not in page(card)
    card["removed_from_train"] = {"stuck_rows": 2, "duplicate_rows": 0}
    assert "Dropped from train by `clean`: 2 stuck rows, 0 duplicate rows." in page(card)


def test_subsets_of_which_rows_were_drawn_say_of_how_many(card: dict[str, Any]) -> None:
    assert "max_scored_rows" not in page(card)
    left = card["subsets"]["test"]["rows"]
    text = page(card | {"drawn_from": {"test": 17820}})
    assert f"Of test {left} of 17820 rows are kept, drawn at random (`max_scored_rows`)." in text


def test_columns_that_are_not_used_are_named_and_orientations_are_said_to_be_left_out(card: dict[str, Any]) -> None:
    assert "does not name" not in page(card)
    card |= {"unused_columns": ["frame", "tip_qw"], "orientation_columns": ["tip_qw"]}
    assert "Columns of the file that the entry does not name: frame, tip" in page(card)
    assert "which is modelled where the entry names it (`orientation`): tip" in page(card)
    assert "Orientation of the tip" not in page(card)
    tip = {"kind": "rotation_matrix", "columns": ["r11", "r12"]}
    assert "Orientation of the tip, rotation_matrix: r11, r12." in page(card | {"orientation": tip})
    many = page(card | {"unused_columns": [f"c{i}" for i in range(20)]})
    assert "c11 and 8 more." in many
