"""Results that are not as they were written, through Snakemake."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pandas as pd
import pytest

from tests.conftest import HOUSE
from tests.workflow.conftest import House

pytestmark = pytest.mark.timeout(600)


def test_an_edited_file_and_a_deleted_model_are_made_anew(house: House, tmp_path: Path) -> None:
    """Although all that was made from them is there."""
    work = tmp_path / "work"
    shutil.copytree(house.work, work)
    there = House(house.root, work, house.mirror)
    quiet = there.looking("--dry-run")[1]
    assert "was changed" not in quiet
    assert "is gone" not in quiet
    raw = work / "results" / "finger" / "raw"
    before = raw.read_bytes()
    raw.write_bytes(before + b" ")
    (work / "results" / "finger" / "lr" / "paper" / "model.joblib").unlink()
    done = house.forked("results/finger/raw", work=work)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (
        "softkin: results/finger/raw was changed since it was written (retrieve finger); it is made anew."
        in done.stderr
    )
    assert raw.read_bytes() == before
    assert "rule fit_model:" in there.looking("--dry-run", "results/finger/calibrated_model.joblib")[1]


def test_what_had_other_params_is_made_anew_though_snakemakes_records_are_lost(house: House, tmp_path: Path) -> None:
    """A seed that was changed in between, say: all that Snakemake sees then is that the files are there."""
    shutil.copytree(house.work, tmp_path / "work", ignore=shutil.ignore_patterns(".snakemake"))
    there = House(house.root, tmp_path / "work", house.mirror)
    assert "other params" not in there.looking("--dry-run")[1]
    said = there.looking("--dry-run", "--config", "seed=7")[1]
    for words in ("fit_model elastica_2023_09 lr", "calibrate elastica_2023_09", "score elastica_2023_09"):
        assert f"softkin: {words} was done with other params (seed); it is done anew." in said
    assert re.search(r"softkin: \d+ more jobs were done with other params; they are done anew\.", said)
    assert "softkin: prepare" not in said
    fewer = ["--config", "max_rows_per_subset=100"]
    table = "results/finger/table.parquet"
    done = there.forked(table, *fewer)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "softkin: prepare finger was done with other params (max_rows); it is done anew." in done.stderr
    assert len(pd.read_parquet(there.work / table)) < len(pd.read_parquet(house.work / table))


def test_the_params_of_every_job_can_be_asked_for() -> None:
    """Of each wildcard that the log of a job has, this run's names are known."""
    rules = HOUSE / "workflow" / "rules"
    logs = [path for file in rules.glob("*.smk") for path in re.findall(r'"(results/logs/.+\.log)"', file.read_text())]
    assert len(logs) > 10
    named = re.findall(r'^    "(\w+)": "\w+",$', (rules / "other_params.smk").read_text(), re.MULTILINE)
    assert set(re.findall(r"{(\w+)}", "".join(logs))) == {"dataset", *named}
