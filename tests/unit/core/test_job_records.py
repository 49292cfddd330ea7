from __future__ import annotations

import os
import pickle
import shutil
import time
from pathlib import Path
from typing import Any

import joblib
import pytest

from softkin.core.errors import ResultError
from softkin.core.files import read_json, write_json
from softkin.core.job import job
from softkin.core.job_records import (
    damages,
    forget_job,
    load_model,
    read_record,
    record_job,
    record_of,
    recorded_sha256,
)

LOG = Path("results/logs/fit_model/finger/gp.log")
MODEL = Path("results/finger/gp/tuned/model.joblib")
FIGURES = Path("results/finger/figures")


@pytest.fixture
def results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A model with its fit, and a folder of figures."""
    monkeypatch.chdir(tmp_path)
    MODEL.parent.mkdir(parents=True)
    FIGURES.mkdir()
    joblib.dump({"weights": [1.0, 2.0]}, MODEL, compress=3)
    (MODEL.parent / "fit.json").write_text('{"seconds": 1.5}')
    for name in ("a.png", "index.csv", ".snakemake_timestamp"):
        (FIGURES / name).write_text(name)
    record_job(LOG, [str(MODEL), str(MODEL.parent / "fit.json")])
    record_job("results/logs/draw_figures/finger.log", [FIGURES])
    return Path("results")


def found(results: Path, *, thorough: bool = False) -> list[tuple[str, str, str, str]]:
    return [(d.path.as_posix(), d.what, d.output.as_posix(), d.job) for d in damages(results, thorough=thorough)]


def later(path: Path) -> None:
    os.utime(path, ns=(0, path.stat().st_mtime_ns + 1_000_000_000))


def test_each_job_has_a_record_of_its_own() -> None:
    assert record_of("/a/logs/b/results/logs/build_tables.log") == Path("/a/logs/b/results/manifest/build_tables.json")
    assert record_of(LOG) == Path("results/manifest/finger/fit_model.gp.json")
    assert record_of("results/logs/prepare/finger.log") == Path("results/manifest/finger/prepare.json")


@pytest.mark.parametrize("thorough", [False, True])
def test_what_is_as_it_was_written_is_not_damaged(results: Path, thorough: bool) -> None:
    assert found(results, thorough=thorough) == []
    (FIGURES / ".snakemake_timestamp").write_text("another time")
    assert found(results, thorough=thorough) == []


@pytest.mark.parametrize("thorough", [False, True])
def test_edited_cut_swapped_and_deleted_files_are_named_with_their_job(results: Path, thorough: bool) -> None:
    fit = MODEL.parent / "fit.json"
    fit.write_text(fit.read_text().replace("1.5", "1.6"))
    later(fit)
    MODEL.unlink()
    (FIGURES / "index.csv").write_bytes(b"ind")
    assert sorted(found(results, thorough=thorough)) == [
        ("results/finger/figures/index.csv", "changed", "results/finger/figures", "draw_figures finger"),
        (fit.as_posix(), "changed", fit.as_posix(), "fit_model finger gp"),
        (MODEL.as_posix(), "missing", MODEL.as_posix(), "fit_model finger gp"),
    ]


def test_a_change_that_keeps_size_and_time_is_found_by_reading(results: Path) -> None:
    fit = MODEL.parent / "fit.json"
    before = fit.stat().st_mtime_ns
    fit.write_text(fit.read_text().replace("1.5", "1.6"))
    os.utime(fit, ns=(before, before))
    assert found(results) == []
    assert [name for name, *_ in found(results, thorough=True)] == [fit.as_posix()]


def test_other_times_alone_are_read_once(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for path in (MODEL, FIGURES / "a.png"):
        later(path)
    assert found(results) == []

    def read(path: Path) -> str:
        raise AssertionError(f"{path} was read again")

    monkeypatch.setattr("softkin.core.job_records.file_sha256", read)
    assert found(results) == []


def test_a_folder_that_is_gone_was_removed_on_purpose(results: Path) -> None:
    shutil.rmtree(results / "finger")
    assert found(results) == []


@pytest.mark.parametrize(
    "content", ["", "{", "[]", '{"files": {"a": 1}, "job": "x"}', '{"job": "x"}', '{"files": 3, "job": ""}']
)
def test_a_record_that_is_none_records_nothing(results: Path, content: str) -> None:
    record_of(LOG).write_text(content)
    assert found(results) == []
    assert recorded_sha256(MODEL) is None
    with pytest.raises(ResultError, match="no record"):
        load_model(MODEL)


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("/etc/passwd", {}),
        ("../../etc/passwd", {}),
        ("results/../../etc/passwd", {}),
        ("config/config.yaml", {}),
        ("results/a\0.csv", {}),
        ("results/a.csv", {"output": 3}),
        ("results/a.csv", {"output": "/etc"}),
        ("results/a.csv", {"sha256": None}),
        ("results/a.csv", {"bytes": "1"}),
    ],
)
def test_a_record_of_files_elsewhere_or_of_other_values_is_none(
    results: Path, name: str, changes: dict[str, Any]
) -> None:
    entry = {"output": "results/a.csv", "sha256": "0" * 64, "bytes": 1, "mtime_ns": 1}
    write_json(record_of(LOG), {"job": "score arm", "params": {}, "files": {"results/a.csv": entry}})
    assert read_record(record_of(LOG)) is not None
    write_json(record_of(LOG), {"job": "score arm", "params": {}, "files": {name: entry | changes}})
    assert read_record(record_of(LOG)) is None
    assert found(results) == []


def test_a_model_is_loaded_by_any_path_to_it(results: Path, tmp_path: Path) -> None:
    del results
    assert load_model(MODEL) == load_model(tmp_path / MODEL) == {"weights": [1.0, 2.0]}


class Attack:
    """Unpickling one makes a file."""

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.mkdir, ("hit",)


@pytest.mark.parametrize("place", [MODEL, Path("results/finger/lr/paper/model.joblib"), Path("elsewhere.joblib")])
def test_what_softkin_did_not_write_is_never_unpickled(results: Path, place: Path) -> None:
    del results
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_bytes(pickle.dumps(Attack()))
    with pytest.raises(ResultError) as error:
        load_model(place)
    assert not Path("hit").exists()
    assert str(place) in str(error.value)
    joblib.load(place)
    assert Path("hit").exists()  # the attack is one


def test_a_job_records_what_it_wrote_when_it_succeeds(results: Path, tmp_path: Path) -> None:
    del results
    log, output = "results/logs/prepare/finger.log", Path("results/finger/table.parquet")
    with job(log, "prepare", [str(output)]):
        output.write_text("rows")
    assert set(read_json(record_of(log))["files"]) == {"results/finger/table.parquet"}
    with pytest.raises(ZeroDivisionError), job(log, "prepare", [str(output)]):
        1 / 0  # noqa: B018
    assert not record_of(log).exists()
    assert recorded_sha256(tmp_path / output) is None
    forget_job(log)


def test_a_record_takes_little_time(results: Path) -> None:
    del results
    (MODEL.parent / "fit.json").write_bytes(os.urandom(4_000_000))
    start = time.process_time()
    record_job(LOG, [MODEL, MODEL.parent / "fit.json", FIGURES])
    assert time.process_time() - start < 0.05


@pytest.mark.parametrize("years", [-50, 50])
def test_clocks_that_jump_and_files_dated_in_the_future_are_no_damage(results: Path, years: int) -> None:
    """A file is what its content is; a wrong date is a reason to read it, and no more."""
    at = time.time() + years * 365 * 86400
    for path in results.rglob("*"):
        if path.is_file():
            os.utime(path, (at, at))
    assert found(results) == []
    assert found(results) == []
    MODEL.write_bytes(MODEL.read_bytes() + b"\0")
    os.utime(MODEL, (at, at))
    assert [one[1] for one in found(results)] == ["changed"]


def test_a_file_that_a_job_leaves_as_it_is_stays_recorded(results: Path) -> None:
    """Of an earlier job of the same log: while the job goes on, where it fails, and when it is done."""
    fit = MODEL.parent / "fit.json"
    before = recorded_sha256(MODEL)
    with pytest.raises(ZeroDivisionError), job(str(LOG), "fit", [str(fit)], kept=[str(MODEL)]):
        1 / 0  # noqa: B018
    assert (recorded_sha256(MODEL), recorded_sha256(fit)) == (before, None)
    with job(str(LOG), "fit", [str(fit)], kept=[str(MODEL)]):
        assert (recorded_sha256(MODEL), recorded_sha256(fit)) == (before, None)
        fit.write_text("{}")
    assert (recorded_sha256(MODEL), found(results)) == (before, [])
    with job(str(LOG), "fit", [str(fit)]):
        fit.write_text("{}")
    assert recorded_sha256(MODEL) is None
