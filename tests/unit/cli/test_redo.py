from __future__ import annotations

from base64 import urlsafe_b64encode
from pathlib import Path

import pytest

from softkin.cli.redo import UNFINISHED, redo_damaged
from softkin.core.job_records import record_job

FILES = [Path(f"results/finger/{name}.csv") for name in "abcdefghijklm"]


@pytest.fixture(autouse=True)
def results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    FILES[0].parent.mkdir(parents=True)
    for path in FILES:
        path.write_text("1,2,3\n")
    record_job("results/logs/score/finger.log", FILES)


def marked() -> set[str]:
    return {path.name for path in UNFINISHED.rglob("*") if path.is_file()}


def test_nothing_is_said_or_done_where_all_is_as_it_was() -> None:
    assert list(redo_damaged(only_say=False)) == []
    assert marked() == set()


def test_damaged_outputs_are_named_and_marked_as_snakemake_marks_them() -> None:
    FILES[0].write_text("1,2,4,\n")
    FILES[1].unlink()
    assert list(redo_damaged(only_say=True)) == list(redo_damaged(only_say=False))
    assert marked() == {urlsafe_b64encode(str(path).encode()).decode() for path in FILES[:2]}
    assert FILES[1].read_text() == ""


def test_a_dry_run_marks_nothing() -> None:
    FILES[1].unlink()
    (said,) = redo_damaged(only_say=True)
    assert said == "results/finger/b.csv is gone (score finger); it is made anew"
    assert marked() == set()
    assert not FILES[1].exists()


def test_of_many_files_the_first_are_named() -> None:
    for path in FILES:
        path.write_text("")
    said = list(redo_damaged(only_say=False))
    assert len(said) == 11
    assert said[-1] == "3 more files are gone or were changed; it is made anew"
    assert len(marked()) == len(FILES)
