from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml

from softkin.core.errors import DataError, ResultError
from softkin.core.files import file_sha256, read_json
from softkin.core.job_records import record_job
from softkin.core.samples import SUBSETS, Samples
from softkin.core.units import MM_PER_UNIT
from softkin.data.prepare import prepare
from softkin.data.readers import table_file
from softkin.data.readers.table_formats import open_table
from softkin.data.scored_rows import DRAWN_FROM, KeptRows
from softkin.data.table import read_subset
from tests.conftest import HOUSE, four_subsets, published_json

SIZES = {"train": 30, "validation": 5, "test": 6, "extrapolation": 7}
SOURCES = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]
PUBLISHED = [name for name, source in SOURCES.items() if "urls" in source]


def entry(**changes: Any) -> dict[str, Any]:
    base = {"title": "Arm", "format": "kinn_json", "file": "arm.json", "position_unit": "mm"}
    return base | {"n_commands": 3, "n_markers": 2, "rows": SIZES} | changes


def run(folder: Path, source: dict[str, Any], **options: Any) -> tuple[Path, Any]:
    (folder / "raw.json").write_text(json.dumps(published_json(four_subsets(SIZES, n_commands=3, n_markers=2))))
    source = {"sha256": file_sha256(folder / "raw.json")} | source
    table, description = folder / "table.parquet", folder / "dataset.json"
    prepare(folder / "raw.json", dataset="arm", source=source, table=table, description=description, **options)
    return table, read_json(description)


@pytest.mark.parametrize("unit", MM_PER_UNIT)
def test_positions_become_millimetres_and_commands_stay(tmp_path: Path, unit: str) -> None:
    table, written_description = run(tmp_path, entry(position_unit=unit))
    original = four_subsets(SIZES, n_commands=3, n_markers=2)
    factor = {"m": 1000, "cm": 10, "mm": 1, "in": 25.4}[unit]
    for subset in SUBSETS:
        rows = read_subset(table, subset)
        np.testing.assert_array_equal(rows.commands, original[subset].commands)
        np.testing.assert_allclose(rows.positions, original[subset].positions * factor, rtol=1e-15)
    assert written_description["rows"] == SIZES
    assert written_description["constant_coordinates"] == ["m1_x", "m1_y", "m1_z"]
    assert list(pd.read_parquet(table).columns[:5]) == ["subset", "u1", "u2", "u3", "m1_x"]


def test_another_number_of_rows_than_registered_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"'arm'.*subset test: 6 rows.*registers 8"):
        run(tmp_path, entry(rows=SIZES | {"test": 8}))
    assert not (tmp_path / "table.parquet").exists()


def test_max_rows_keeps_the_first_rows_and_says_so(tmp_path: Path) -> None:
    _, written_description = run(tmp_path, entry(), kept=KeptRows(first=25))
    assert written_description["rows"] == SIZES | {"train": 25}
    assert written_description["is_cut"]
    assert not run(tmp_path, entry())[1]["is_cut"]


def test_of_many_rows_to_score_some_are_drawn_and_the_description_says_of_how_many(tmp_path: Path) -> None:
    table, written_description = run(tmp_path, entry(), kept=KeptRows(scored=6))
    assert written_description["rows"] == SIZES | {"extrapolation": 6}
    assert written_description[DRAWN_FROM] == {"extrapolation": 7}
    assert not written_description["is_cut"]
    assert len(read_subset(table, "extrapolation")) == 6
    assert DRAWN_FROM not in run(tmp_path, entry(), kept=KeptRows(scored=7))[1]


def test_a_table_of_ones_own_is_read_once_and_described_by_what_it_holds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[Path] = []

    def opening(path: Path, source: Mapping[str, Any]) -> Any:
        opened.append(path)
        return open_table(path, source)

    monkeypatch.setattr(table_file, "open_table", opening)
    example = HOUSE / "config" / "examples" / "bending_arm.csv"
    source = {"title": "Arm", "format": "table_file", "file": str(example), "position_unit": "in", "dimensions": 2}
    source |= {"commands": "p[0-9]_bar", "positions": ".*_[xz]", "split": {"method": "random", "seed": 3}}
    table, description = tmp_path / "table.parquet", tmp_path / "dataset.json"
    prepare(example, dataset="arm", source=source, table=table, description=description)
    assert opened == [example]
    written_description = read_json(description)
    assert written_description["sha256"] == hashlib.sha256(example.read_bytes()).hexdigest()
    assert (written_description["n_commands"], written_description["n_markers"]) == (3, 2)
    assert written_description["rows"] == {"train": 336, "validation": 42, "test": 42, "extrapolation": 180}
    assert written_description["constant_coordinates"] == ["m1_z", "m2_z"]
    named = written_description["columns"]
    assert (len(named["commands"]), len(named["positions"])) == (written_description["n_commands"], 4)
    assert (named["dimensions"], named["mm_per_unit"]) == (2, 25.4)
    others = set(pd.read_csv(example, nrows=1).columns) - {*named["commands"], *named["positions"]}
    assert set(written_description.get("unused_columns", [])) == others
    assert "orientation_columns" not in written_description
    written, prepared = pd.read_csv(example), pd.read_parquet(table)
    by = ["u1", "u2", "u3"]
    prepared = prepared.sort_values(by)
    written = written.sort_values(["p1_bar", "p2_bar", "p3_bar"])
    np.testing.assert_array_equal(prepared["m2_y"], written["tip_z"] * 25.4)
    source["rows"] = written_description["rows"] | {"train": 300}
    with pytest.raises(DataError, match="registers 300"):
        prepare(example, dataset="arm", source=source, table=table, description=description)


@pytest.mark.parametrize(("unit", "warned"), [("mm", False), ("m", True), ("in", False)])
def test_an_implausible_workspace_is_warned_of(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, unit: str, warned: bool
) -> None:
    run(tmp_path, entry(position_unit=unit))
    assert ("correct `position_unit`" in caplog.text) == warned


@pytest.mark.parametrize("dataset", PUBLISHED)
def test_published_subset_sizes_are_those_of_table_2(dataset: str, tmp_path: Path, published_mirror: Path) -> None:
    source = SOURCES[dataset]
    raw = published_mirror / source["file"]
    table, description = tmp_path / "table.parquet", tmp_path / "dataset.json"
    prepare(raw, dataset=dataset, source=source, table=table, description=description)
    printed = pd.read_csv(HOUSE / "resources" / "published" / "subsets.csv")
    written_description = read_json(description)
    paper_name = dataset.removesuffix("_2023_09")
    for row in printed[printed["dataset"] == paper_name].itertuples():
        rows = read_subset(table, str(row.subset))
        assert rows.commands.shape == (row.n_rows, row.n_commands)
        assert rows.positions.shape == (row.n_rows, row.n_coordinates)
        assert written_description["rows"][row.subset] == row.n_rows
    assert written_description["constant_coordinates"] == (["m1_x", "m1_y", "m1_z"] if dataset == "abaqus" else [])


def test_rows_that_are_cleaned_away_are_counted(tmp_path: Path) -> None:
    """`train` only, and only where it was asked for."""

    def without_the_first_two(samples: Mapping[str, Samples]) -> tuple[dict[str, Samples], dict[str, int]]:
        train = samples["train"]
        kept = Samples(train.commands[2:], train.positions[2:])
        return {**samples, "train": kept}, {"stuck_rows": 2, "duplicate_rows": 0}

    assert run(tmp_path, entry())[1]["removed_from_train"] is None
    table, written_description = run(tmp_path, entry(), clean=without_the_first_two)
    assert written_description["removed_from_train"] == {"stuck_rows": 2, "duplicate_rows": 0}
    assert written_description["rows"] == SIZES | {"train": 28}
    assert not written_description["is_cut"]
    assert len(read_subset(table, "train")) == 28


def test_a_file_that_was_changed_since_it_was_retrieved_is_refused(tmp_path: Path) -> None:
    """By the hash of its entry, and by the record of `retrieve` for a file of one's own."""
    with pytest.raises(ResultError, match=r"sha256 is [0-9a-f]{64}, expected 0000"):
        run(tmp_path, entry(sha256="0" * 64))
    raw = tmp_path / "arm" / "raw"
    raw.parent.mkdir()
    shutil.copy(tmp_path / "raw.json", raw)
    record_job(tmp_path / "logs" / "retrieve" / "arm.log", [raw])
    options: dict[str, Any] = {"table": tmp_path / "table.parquet", "description": tmp_path / "dataset.json"}
    prepare(raw, dataset="arm", source=entry(), **options)
    raw.write_text(raw.read_text() + " ")
    with pytest.raises(ResultError, match="changed since it was retrieved"):
        prepare(raw, dataset="arm", source=entry(), **options)


def test_case_29_relabel_puts_markers_in_order_in_every_subset_and_counts_them(tmp_path: Path) -> None:
    path = HOUSE / "tests" / "cases" / "29_swapped_marker_labels.csv"
    names = [f"{axis}{place}" for place in (1, 2, 3) for axis in "xyz"]
    source: dict[str, Any] = {"title": "Arm", "format": "table_file", "file": path.name, "position_unit": "mm"}
    source |= {"commands": ["u1", "u2"], "positions": names, "split": {"method": "random"}}
    counts = {}
    for relabel in (False, True):
        table, description = tmp_path / f"{relabel}.parquet", tmp_path / f"{relabel}.json"
        entry = source | {"relabel": relabel}
        prepare(path, dataset="arm", source=entry, table=table, description=description)
        counts[relabel] = read_json(description).get("relabelled_rows")
        heights = np.vstack([read_subset(table, subset).positions[:, [2, 5]] for subset in SUBSETS])
        assert len({first < second for first, second in heights.tolist()}) == (1 if relabel else 2)
    assert counts[False] is None
    assert sum(counts[True].values()) == 60


def test_pixels_stay_pixels_and_the_description_says_so(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    table, about = run(tmp_path, entry(position_unit="px"))
    original = four_subsets(SIZES, n_commands=3, n_markers=2)
    np.testing.assert_array_equal(read_subset(table, "test").positions, original["test"].positions)
    assert about["unit"] == "px"
    assert "positions range over" not in caplog.text
    assert "unit" not in run(tmp_path, entry(position_unit="in"))[1]
