from __future__ import annotations

import json
import logging
import os
import sqlite3
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from optuna.trial import Trial, TrialState

from softkin.core.samples import Params
from softkin.training.journal import heal, is_of
from softkin.training.study import Search, StudyFile, TuningResult, TuningSettings, run_study
from tests.conftest import bending_arm

#: Beyond the tenth trial the sampler learns from the trials before.
SETTINGS = TuningSettings(n_trials=12, n_folds=2, max_rows=60, seed=3)
ROWS = bending_arm(20)


def valley() -> Search:
    """A number and a choice; trials that end complete, pruned, and by an infinite error."""

    def space(trial: Trial) -> Params:
        return {
            "x": trial.suggest_float("x", -10.0, 10.0),
            "shape": trial.suggest_categorical("shape", ["round", "flat"]),
        }

    def errors_of(params: Params) -> Iterator[float]:
        for part in range(2):
            error = (params["x"] - 1.0 / 3.0) ** 2 + (params["shape"] == "flat") / 7.0 + part
            yield error if params["x"] < 8.0 else float("inf")

    starts = ({"x": -3.0, "shape": "flat"}, {"x": 9.0, "shape": "round"})
    return Search("valley", space, starts, errors_of, n_parts=2)


def run(path: Path, settings: TuningSettings = SETTINGS) -> TuningResult:
    return run_study(ROWS, search=valley(), settings=settings, file=StudyFile(path, "code"))


@pytest.fixture(autouse=True)
def no_waiting_for_the_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    """No power is cut here, and ten thousand writes are made."""
    monkeypatch.setattr(os, "fsync", lambda _: None)


def assert_same(result: TuningResult, undisturbed: TuningResult) -> None:
    one, two = (each.trials.drop(columns=["seconds", "cpu_seconds"]) for each in (result, undisturbed))
    pd.testing.assert_frame_equal(one, two, check_exact=True)
    assert result.complete == undisturbed.complete


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, TuningResult]:
    """The journal of an undisturbed study, and its result."""
    path = tmp_path_factory.mktemp("undisturbed") / "whole.journal"
    result = run(path)
    assert {"COMPLETE", "PRUNED"} == set(result.trials["state"])
    return path.read_bytes(), result


@pytest.mark.parametrize("step", [pytest.param(1, marks=pytest.mark.slow), 3])
def test_a_study_killed_between_any_two_writes_ends_as_an_undisturbed_one(
    tmp_path: Path, whole: tuple[bytes, TuningResult], caplog: pytest.LogCaptureFixture, step: int
) -> None:
    """Enqueued and not started, started without parameters, scored without an end: each is the end of some line, of
    every trial anew, so that every third line has them all.
    """
    lines = whole[0].splitlines(keepends=True)
    assert len(lines) > 100
    for kept in range(0, len(lines), step):
        path = tmp_path / f"{kept}.journal"
        path.write_bytes(b"".join(lines[:kept]))
        assert_same(run(path), whole[1])
    assert "torn" not in caplog.text


def test_a_last_record_torn_at_any_byte_heals(
    tmp_path: Path, whole: tuple[bytes, TuningResult], caplog: pytest.LogCaptureFixture
) -> None:
    lines = whole[0].splitlines(keepends=True)
    before, last = b"".join(lines[:-1]), lines[-1]
    path = tmp_path / "a.journal"
    for written in range(1, len(last)):
        path.write_bytes(before + last[:written])
        caplog.clear()
        heal(path)
        assert path.read_bytes() == before
        assert f"its last {written} bytes are cut off" in caplog.text
        if written % 10 == 1:
            path.write_bytes(before + last[:written])
            assert_same(run(path), whole[1])
            assert all(json.loads(line) for line in path.read_bytes().splitlines())
    path.write_bytes(whole[0])
    caplog.clear()
    assert_same(run(path), whole[1])
    warned = [record for record in caplog.records if record.levelname == "WARNING"]
    assert (path.read_bytes(), warned) == (whole[0], [])


@pytest.mark.parametrize("torn", [b"\0" * 80, b"\0" * 80 + b"\n", b"\xff\xfe\n", b'{"op_code":4\n', b"7\n", b"{}\n"])
def test_a_last_line_that_is_no_record_heals(tmp_path: Path, whole: tuple[bytes, TuningResult], torn: bytes) -> None:
    """After a power cut a file may be as long as it should and hold zeros."""
    lines = whole[0].splitlines(keepends=True)
    half = b"".join(lines[: len(lines) // 2])
    for behind in (b"", lines[len(lines) // 2]):
        path = tmp_path / "a.journal"
        path.write_bytes(half + torn + behind)
        heal(path)
        assert path.read_bytes() == half
    path.write_bytes(half + torn)
    assert_same(run(path), whole[1])


def garbage(path: Path) -> None:
    path.write_bytes(b"\x93NUMPY\n" * 50)


def empty(path: Path) -> None:
    path.touch()


def sqlite_study(path: Path) -> None:
    """As studies were kept before."""
    store = sqlite3.connect(path)
    with store:
        store.execute("CREATE TABLE studies (study_id INTEGER PRIMARY KEY, study_name TEXT)")
        store.execute("INSERT INTO studies VALUES (1, 'lasso')")
    store.close()


@pytest.mark.parametrize("write", [garbage, empty, sqlite_study])
def test_a_file_that_is_no_journal_is_replaced_and_the_log_says_so(
    tmp_path: Path, whole: tuple[bytes, TuningResult], write: Callable[[Path], None], caplog: pytest.LogCaptureFixture
) -> None:
    path = tmp_path / "a.journal"
    write(path)
    assert_same(run(path), whole[1])
    assert f"{path} is no journal of a study: a new study replaces it" in caplog.text


def test_the_journal_of_another_study_is_replaced_and_the_log_says_so(
    tmp_path: Path, whole: tuple[bytes, TuningResult], caplog: pytest.LogCaptureFixture
) -> None:
    path = tmp_path / "a.journal"
    with caplog.at_level(logging.INFO, logger="softkin"):
        run(path, replace(SETTINGS, seed=4, n_trials=2))
        assert not is_of(path, "other")
        assert "is a study of other data, settings, code or libraries" in caplog.text
        caplog.clear()
        assert_same(run(path), whole[1])
    assert "a new one replaces it" in caplog.text
    assert path.read_bytes().count(b'"study_name"') == 1


def test_a_lock_that_a_killed_process_left_holds_nobody_up(tmp_path: Path, whole: tuple[bytes, TuningResult]) -> None:
    """Optuna's own locks wait half a minute for the holder."""
    path = tmp_path / "a.journal"
    Path(f"{path}.lock").touch()
    start = time.monotonic()
    assert_same(run(path), whole[1])
    assert time.monotonic() - start < 20.0


def test_each_trial_that_has_ended_is_on_the_disk_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    synced: list[int] = []
    monkeypatch.setattr(os, "fsync", lambda descriptor: synced.append(os.fstat(descriptor).st_size))
    run(tmp_path / "one.journal")
    lines = (tmp_path / "one.journal").read_bytes().splitlines(keepends=True)
    sizes = np.cumsum([len(line) for line in lines]).tolist()
    states = [json.loads(line).get("state") for line in lines]
    ended = [
        size for size, state in zip(sizes, states, strict=True) if state in (TrialState.COMPLETE, TrialState.PRUNED)
    ]
    assert len(ended) == SETTINGS.n_trials
    assert set(ended) <= set(synced)
    assert len(synced) < len(lines) / 2  # and not each of its records
