from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from softkin.core.escaping import markdown_text
from softkin.core.files import read_json
from softkin.core.samples import SUBSETS, Samples
from softkin.data.audit import CHECKS
from softkin.data.audit.data_card import audit, left_out
from softkin.data.table import to_table, write_table
from tests.conftest import bending_arm
from tests.unit.data.audit.clean_robot import clean_robot
from tests.unit.data.audit.conftest import Replace


def audited(samples: dict[str, Samples], folder: Path, **more: Any) -> tuple[dict[str, Any], str]:
    table, card, readable = folder / "table.parquet", folder / "data_card.json", folder / "data_card.md"
    write_table(to_table(samples), table)
    audit(table, dataset="arm", title="Arm", position_unit="m", data_card=card, readable=readable, **more)
    return read_json(card), readable.read_text(encoding="utf-8")


def test_a_clean_robot_has_a_card_without_findings(robot: dict[str, Samples], tmp_path: Path) -> None:
    card, readable = audited(robot, tmp_path)
    assert (card["worst_severity"], card["is_leaking"], card["findings"]) == (None, False, [])
    assert list(card["checks"]) == list(CHECKS)
    assert {subset: card["subsets"][subset]["rows"] for subset in SUBSETS} == {s: len(robot[s]) for s in SUBSETS}
    m2_z = robot["test"].positions[:, 5]
    assert card["subsets"]["test"]["positions_mm"]["m2_z"] == [m2_z.min(), m2_z.max()]
    u1 = robot["test"].commands[:, 0]
    assert card["subsets"]["test"]["commands"]["u1"] == [u1.min(), u1.max()]
    assert (card["unit"], card["unit_in_file"], card["removed_from_train"]) == ("mm", "m", None)
    assert "There are no findings" in readable
    assert "by `clean`" not in readable


def test_findings_stand_in_card_and_page(robot: dict[str, Samples], changed: Replace, tmp_path: Path) -> None:
    first = robot["train"].take(slice(20))
    samples = changed("test", slice(0, 20), commands=first.commands, positions=first.positions)
    samples = changed("train", [300], positions=robot["train"].positions[5], of=samples)
    removed = {"stuck_rows": 3, "duplicate_rows": 0}
    card, readable = audited(samples, tmp_path, description={"removed_from_train": removed})
    assert (card["worst_severity"], card["is_leaking"]) == ("leak", True)
    assert {"copied_commands", "stuck_poses"} <= {finding["code"] for finding in card["findings"]}
    for finding in card["findings"]:
        assert markdown_text(finding["sentence"]) in readable
        assert markdown_text(finding["consequence"]) in readable
    assert "test, 20 rows (numbered from 0): 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, ..." in readable
    assert "train, 1 row (numbered from 0): 300" in readable
    assert "Dropped from train by `clean`: 3 stuck rows, 0 duplicate rows." in readable


def test_an_audit_says_the_same_twice(robot: dict[str, Samples], tmp_path: Path) -> None:
    assert audited(robot, tmp_path) == audited(robot, tmp_path)


@pytest.mark.parametrize("n_rows", [12, 60])
def test_small_and_wide_data_get_a_card_too(n_rows: int, tmp_path: Path) -> None:
    card, readable = audited(clean_robot(n_rows, n_commands=40, n_markers=3, seed=0), tmp_path)
    assert {finding["code"] for finding in card["findings"]} <= {"few_calibration_rows"}
    assert "Not measured: too few distinct rows" in readable
    assert "too few rows" in readable
    assert "37 more columns" in readable


def single_rows() -> dict[str, Samples]:
    return {subset: Samples(np.full((1, 1), float(place)), np.zeros((1, 3))) for place, subset in enumerate(SUBSETS)}


def test_a_single_row_each_gets_a_card_too(tmp_path: Path) -> None:
    card, readable = audited(single_rows(), tmp_path)
    codes = {finding["code"] for finding in card["findings"]}
    assert codes == {"constant_coordinates", "constant_commands", "few_calibration_rows"}
    assert "Not measured: no coordinate moves" in readable
    assert card["base"] == {"not_measured": "no marker moves"}
    assert "Not measured: no marker moves." in readable


def test_the_card_says_where_the_base_stands_and_who_says_so(tmp_path: Path) -> None:
    shift = np.array([10.0, 20.0, 30.0])
    arms = {}
    for n in (1, 3):
        # The base is estimated from train; the other subsets are too small for a classifier.
        sizes = {subset: 100 if subset == "train" else 15 for subset in SUBSETS}
        rows = {subset: bending_arm(sizes[subset], n_markers=n, seed=place) for place, subset in enumerate(SUBSETS)}
        arms[n] = {subset: replace(of, positions=of.positions + np.tile(shift, n)) for subset, of in rows.items()}
    whole = audited(arms[1], tmp_path, base={"origin": [10.0, 20.0, 30.0], "axis": [0, 0, 2]})
    assert whole[0]["base"] == {
        "origin_mm": [10.0, 20.0, 30.0],
        "origin_from": ["declared"] * 3,
        "axis": [0.0, 0.0, 1.0],
        "axis_from": "declared",
    }
    assert "x 10 (declared), y 20 (declared), z 30 (declared) mm" in whole[1]
    depth = audited(arms[1], tmp_path, base={"origin": [10.0, 20.0, None]})[0]["base"]
    assert depth["origin_from"] == ["declared", "declared", "estimated"]
    assert depth["origin_mm"][2] == pytest.approx(30.0, abs=3.0)
    np.testing.assert_allclose(depth["axis"], [0, 0, 1], atol=0.02)
    constant = audited(arms[3], tmp_path)[0]["base"]
    assert constant["origin_from"] == ["a marker that never moves"] * 3
    assert constant["origin_mm"] == pytest.approx([10.0, 20.0, 30.0])
    assert constant["axis_from"] == "estimated"


@pytest.mark.parametrize(
    "keys",
    [
        {"removed_from_train": None},
        {"removed_from_train": {"stuck_rows": 2}},
        {"removed_from_train": None, "rows_with_gaps": 3},
        {"removed_from_train": {"stuck_rows": 2}, "rows_with_gaps": 3},
    ],
)
def test_what_was_left_out_of_a_dataset_is_a_part_of_its_card(keys: dict[str, Any], tmp_path: Path) -> None:
    description = {"dataset": "arm", "rows": {}} | keys
    assert left_out(description) == keys
    card, _ = audited(single_rows(), tmp_path, description=description)
    assert {key: card[key] for key in card if key in keys or key == "rows_with_gaps"} == keys


def test_findings_call_columns_as_the_robots_own_file_does(robot: dict[str, Samples], tmp_path: Path) -> None:
    copied = {
        name: Samples(np.column_stack([rows.commands, 2 * rows.commands[:, 0]]), rows.positions)
        for name, rows in robot.items()
    }
    names = {"commands": ["left", "right", "both"], "positions": [f"{m} {axis}" for m in "AB" for axis in "XYZ"]}
    card, readable = audited(copied, tmp_path, description={"columns": names | {"dimensions": 3}})
    assert [finding["sentence"] for finding in card["findings"]] == ["both is 2 times left."]
    assert "both is 2 times left" in readable


def test_relabelled_rows_stand_in_card_and_page(tmp_path: Path) -> None:
    counts = {"train": 7, "validation": 0, "test": 1, "extrapolation": 2}
    card, readable = audited(single_rows(), tmp_path, description={"relabelled_rows": counts})
    assert card["relabelled_rows"] == counts
    assert "`relabel: true`, rows: 7 of train, 0 of validation, 1 of test, 2 of extrapolation." in readable


def test_a_card_of_pixels_says_pixels(robot: dict[str, Samples], changed: Replace, tmp_path: Path) -> None:
    samples = changed("train", [300], positions=robot["train"].positions[5])
    card, readable = audited(samples, tmp_path, description={"unit": "px"})
    (far,) = [finding["sentence"] for finding in card["findings"] if finding["code"] == "stuck_poses"]
    assert " px from where the rows around them" in far
    assert card["unit"] == "px"
    assert "positions in px" in readable
    assert not re.search(r"\bmm\b", readable)
