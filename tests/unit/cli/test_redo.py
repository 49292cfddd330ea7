from __future__ import annotations

import shutil
from base64 import urlsafe_b64encode
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from softkin.cli.redo import FINISHED, UNFINISHED, redo_changed, redo_damaged
from softkin.core.job_records import read_record, record_job

FILES = [Path(f"results/finger/{name}.csv") for name in "abcdefghijklm"]


@pytest.fixture(autouse=True)
def results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    FILES[0].parent.mkdir(parents=True)
    for path in FILES:
        path.write_text("1,2,3\n")
    record_job("results/logs/score/finger.log", FILES)


def damaged(*, only_say: bool) -> list[str]:
    return redo_damaged(only_say=only_say)[0]


def changed(params_of: Callable[[str], Mapping[str, Any] | None], *, only_say: bool) -> list[str]:
    return list(redo_changed(redo_damaged(only_say=True)[1], params_of, only_say=only_say))


def marked() -> set[str]:
    return {path.name for path in UNFINISHED.rglob("*") if path.is_file()}


def test_nothing_is_said_or_done_where_all_is_as_it_was() -> None:
    assert damaged(only_say=False) == []
    assert marked() == set()


def test_damaged_outputs_are_named_and_marked_as_snakemake_marks_them() -> None:
    FILES[0].write_text("1,2,4,\n")
    FILES[1].unlink()
    assert damaged(only_say=True) == damaged(only_say=False)
    assert marked() == {urlsafe_b64encode(str(path).encode()).decode() for path in FILES[:2]}
    assert FILES[1].read_text() == ""


def test_a_dry_run_marks_nothing() -> None:
    FILES[1].unlink()
    (said,) = damaged(only_say=True)
    assert said == "results/finger/b.csv is gone (score finger); it is made anew"
    assert marked() == set()
    assert not FILES[1].exists()


def test_of_many_files_the_first_are_named() -> None:
    for path in FILES:
        path.write_text("")
    said = damaged(only_say=False)
    assert len(said) == 11
    assert said[-1] == "3 more files are gone or were changed; it is made anew"
    assert len(marked()) == len(FILES)


SCORE, FIT = "score finger", "fit_model finger lr"
PARAMS: dict[str, dict[str, Any]] = {SCORE: {"seed": 1, "methods": ["qr"]}, FIT: {"seed": 1, "code": "ab"}}


def test_what_was_done_with_other_params_is_done_anew_where_snakemake_has_lost_its_records() -> None:
    record_job("results/logs/score/finger.log", FILES[:2], PARAMS[SCORE])
    record_job("results/logs/fit_model/finger/lr.log", FILES[2:3], PARAMS[FIT])
    assert changed(PARAMS.get, only_say=False) == []
    assert marked() == set()
    now: Mapping[str, dict[str, Any]] = {SCORE: {"methods": ["qr", "cqr"], "regions": []}}
    said = ["score finger was done with other params (methods, regions, seed); it is done anew"]
    assert changed(now.get, only_say=True) == said
    assert marked() == set()
    assert changed(now.get, only_say=False) == said
    assert marked() == {urlsafe_b64encode(str(path).encode()).decode() for path in FILES[:2]}


def test_where_snakemake_has_its_records_it_compares_by_itself() -> None:
    record_job("results/logs/score/finger.log", FILES[:1], PARAMS[SCORE])
    FINISHED.mkdir(parents=True)
    (FINISHED / urlsafe_b64encode(str(FILES[0]).encode()).decode()).touch()
    assert changed({SCORE: {"seed": 2}}.get, only_say=False) == []


def test_what_was_removed_with_its_folder_is_not_marked() -> None:
    """Of a job whose outputs are partly gone the others are; of one whose outputs are all gone nothing is said."""
    one, other = (Path(f"results/{folder}/a.csv") for folder in ("arm", "leg"))
    for path in (one, other):
        path.parent.mkdir()
        path.write_text("1,2,3\n")
    record_job("results/logs/score/finger.log", [one, FILES[0]], {"seed": 1})
    record_job("results/logs/score/leg.log", [other], {"seed": 1})
    for path in (one, other):
        shutil.rmtree(path.parent)
    said = changed(lambda _: {"seed": 2}, only_say=False)
    assert said == ["score finger was done with other params (seed); it is done anew"]
    assert marked() == {urlsafe_b64encode(str(FILES[0]).encode()).decode()}


def test_of_many_jobs_the_first_are_named() -> None:
    for path in FILES:
        record_job(f"results/logs/fit_model/finger/{path.stem}.log", [path], {"seed": 1})
    said = changed(lambda words: {"seed": 2} if words.startswith("fit_model") else None, only_say=True)
    assert len(said) == 11
    assert said[0] == "fit_model finger a was done with other params (seed); it is done anew"
    assert said[-1] == "3 more jobs were done with other params; they are done anew"


def test_the_records_of_jobs_are_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    record_job("results/logs/score/finger.log", FILES[:1], PARAMS[SCORE])
    read: list[Path] = []

    def reading(record: Path) -> Any:
        read.append(record)
        return read_record(record)

    monkeypatch.setattr("softkin.core.job_records.read_record", reading)
    assert len(changed({SCORE: {"seed": 2}}.get, only_say=False)) == 1
    assert read == [Path("results/manifest/finger/score.json")]
