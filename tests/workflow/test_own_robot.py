"""A local file is read into its table, and again when the file changes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import yaml

from softkin.core.files import read_json
from tests.conftest import HOUSE
from tests.workflow.conftest import House, copy_house, jobs_of

pytestmark = pytest.mark.timeout(600)

TABLE = "results/arm/table.parquet"


def test_an_edited_file_is_read_again_and_an_untouched_one_is_not(tmp_path: Path, mirror: Path) -> None:
    copy_house(tmp_path / "house")
    (tmp_path / "work" / "data").mkdir(parents=True)
    house = House(tmp_path / "house", tmp_path / "work", mirror)
    file = house.work / "data" / "arm.csv"
    lines = (HOUSE / "config" / "examples" / "bending_arm.csv").read_text().splitlines()
    entry: dict[str, Any] = {"title": "Arm", "format": "table_file", "file": "data/arm.csv", "position_unit": "mm"}
    entry |= {"commands": "p[0-9]_bar", "positions": ".*_[xyz]", "split": {"method": "random"}}
    more = tmp_path / "more.yaml"
    more.write_text(yaml.safe_dump({"datasets": ["arm"], "sources": {"arm": entry}, "max_rows_per_subset": None}))

    status, missing = house.looking(TABLE, more=more)
    assert status != 0
    assert "data/arm.csv" in missing
    assert "Traceback" not in missing

    file.write_text("\n".join(lines[:401]) + "\n")
    done = house.forked(TABLE, "--printshellcmds", more=more)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "localrule prepare:" in done.stderr, "Snakemake's own output was asked for"
    assert len(pd.read_parquet(house.work / TABLE)) == 400
    assert sum(read_json(house.work / "results" / "arm" / "dataset.json")["rows"].values()) == 400
    assert "Nothing to be done" in house.looking(TABLE, more=more)[1]
    file.write_text("\n".join(lines[:601]) + "\n")
    again = jobs_of(house.looking(TABLE, "--dry-run", more=more)[1])
    assert again == [("retrieve", "dataset=arm"), ("prepare", "dataset=arm")]
