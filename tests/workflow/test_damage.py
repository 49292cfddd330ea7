"""Results that are not as they were written, through Snakemake."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.workflow.conftest import House

pytestmark = pytest.mark.timeout(600)


def test_an_edited_file_and_a_deleted_model_are_made_anew(house: House, tmp_path: Path) -> None:
    """Although all that was made from them is there."""
    work = tmp_path / "work"
    shutil.copytree(house.work, work)
    quiet = house.snakemake("--dry-run", work=work)
    assert "was changed" not in quiet.stderr
    assert "is gone" not in quiet.stderr
    raw = work / "results" / "finger" / "raw"
    before = raw.read_bytes()
    raw.write_bytes(before + b" ")
    (work / "results" / "finger" / "lr" / "paper" / "model.joblib").unlink()
    done = house.snakemake("results/finger/raw", work=work)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (
        "softkin: results/finger/raw was changed since it was written (retrieve finger); it is made anew."
        in done.stderr
    )
    assert raw.read_bytes() == before
    waiting = house.snakemake("--dry-run", "results/finger/calibrated_model.joblib", work=work)
    assert "rule fit_model:" in waiting.stdout + waiting.stderr
