"""A calibrated model is loaded where its hash is as recorded, or as given; nothing else in a file is run."""

from __future__ import annotations

import hashlib
import os
import pickle
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pytest

import softkin
from softkin.core.errors import ResultError
from softkin.core.job_records import record_job
from softkin.uncertainty import file_format
from softkin.uncertainty.loading import load
from tests.unit.uncertainty.small_robot import small_robot

MODEL = Path("results/arm/calibrated_model.joblib")


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A calibrated model in a project."""
    monkeypatch.chdir(tmp_path)
    MODEL.parent.mkdir(parents=True)
    joblib.dump(small_robot(), MODEL, compress=3)
    record_job("results/logs/calibrate/arm.log", [MODEL])
    return MODEL


def hash_of(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_a_recorded_model_is_loaded_and_answers_as_before(model: Path) -> None:
    robot = softkin.load(model)
    np.testing.assert_array_equal(robot.predict([0.1, 0.2]), small_robot().predict([0.1, 0.2]))
    assert len(repr(robot).splitlines()) == 8
    assert load(model, sha256=hash_of(model)).dataset == "arm"


def test_what_is_unpickled_are_the_bytes_that_were_hashed(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reads: list[Path] = []

    def read(path: Path) -> bytes:
        reads.append(path)
        with path.open("rb") as file:
            return file.read()

    monkeypatch.setattr(Path, "read_bytes", read)
    load(model)
    assert reads == [model]


def test_a_model_from_elsewhere_needs_its_hash_or_trust(model: Path) -> None:
    taken = Path("taken.joblib")
    taken.write_bytes(model.read_bytes())
    with pytest.raises(ResultError, match=r"no record beside it .*\n  fix: pass the sha256"):
        load(taken)
    assert load(taken, sha256=hash_of(model).upper()).dataset == load(taken, trust=True).dataset == "arm"
    with pytest.raises(ResultError, match="not the one that was given"):
        load(taken, sha256="00" * 32)


class Attack:
    """Unpickling one makes a folder."""

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.mkdir, ("hit",)


@pytest.mark.parametrize("arguments", [{}, {"trust": True}, {"sha256": "00" * 32}])
def test_what_was_changed_is_never_run(model: Path, arguments: dict[str, Any]) -> None:
    model.write_bytes(pickle.dumps(Attack()))
    with pytest.raises(ResultError):
        load(model, **arguments)
    with pytest.raises(ResultError, match="changed since softkin wrote it"):
        load(model, trust=True)
    assert not Path("hit").exists()


def test_another_format_is_refused_in_a_sentence(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file_format, "FORMAT", file_format.FORMAT + 1)
    with pytest.raises(ResultError, match="of format 5, where this version of softkin reads 6") as caught:
        load(model)
    assert caught.value.where == str(model)
    assert "run the workflow again" in str(caught.value.fix)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "cannot be read by this version"),
        (b"a,b\n1,2\n", "cannot be read by this version"),
        (b"csoftkin.uncertainty.gone\nNothing\n.", "cannot be read by this version .*ModuleNotFoundError"),
        (pickle.dumps({"weights": 1}), "it holds no calibrated model, but a dict"),
    ],
)
def test_what_is_no_model_is_refused(tmp_path: Path, content: bytes, says: str) -> None:
    (tmp_path / "file.joblib").write_bytes(content)
    with pytest.raises(ResultError, match=says):
        load(tmp_path / "file.joblib", trust=True)


def test_no_file_is_one_sentence(tmp_path: Path) -> None:
    for path in (tmp_path / "none.joblib", tmp_path):
        with pytest.raises(ResultError, match=r"no such file\n  fix: name the calibrated_model"):
            load(path)


@pytest.mark.parametrize("path", [None, 5, b"model.joblib"])
def test_what_is_no_path_is_refused(path: Any) -> None:
    with pytest.raises(ResultError, match="is no path"):
        load(path)
