"""Stores that cannot be used: each is one sentence that names the file and the fix, and is left as it was."""

from __future__ import annotations

import os
import re
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from softkin.core.errors import StoreError
from softkin.tracking import open_store, store
from softkin.tracking.open_store import check_file
from softkin.tracking.store import Campaign, client_of, create_store

HOLD = """
import sqlite3, sys, time
connection = sqlite3.connect(sys.argv[1], isolation_level=None)
connection.execute("BEGIN EXCLUSIVE")
print("locked", flush=True)
time.sleep(float(sys.argv[2]))
connection.execute("COMMIT")
"""


@pytest.fixture
def file(campaign: Campaign) -> Path:
    return Path(campaign.tracking_uri.removeprefix("sqlite:///"))


def change(file: Path, *statements: str) -> None:
    with closing(sqlite3.connect(file)) as connection, connection:
        for statement in statements:
            connection.execute(statement)


def as_text(file: Path) -> None:
    file.write_text("a note of mine\n" * 400)


def as_picture(file: Path) -> None:
    file.write_bytes(b"\x89PNG\r\n" + bytes(5000))


def as_database_of_somebody_else(file: Path) -> None:
    file.unlink()
    change(file, "CREATE TABLE bookmarks (url TEXT)")


def as_empty_database(file: Path) -> None:
    file.write_bytes(b"")


def as_newer(file: Path) -> None:
    change(file, "UPDATE alembic_version SET version_num = 'ffffffffffff'")


def as_older(file: Path) -> None:
    change(file, f"UPDATE alembic_version SET version_num = '{open_store._versions()[1]}'")


def as_half(file: Path) -> None:
    os.truncate(file, file.stat().st_size // 2)


def as_overwritten(file: Path) -> None:
    with file.open("r+b") as there:
        there.seek(100)
        there.write(b"\xff" * 3000)


def as_folder(file: Path) -> None:
    file.unlink()
    file.mkdir()


FAULTS: dict[str, tuple[Callable[[Path], None], str]] = {
    "a text file": (as_text, "this file is no database"),
    "a picture": (as_picture, "this file is no database"),
    "a foreign database": (as_database_of_somebody_else, "no MLflow store; it holds bookmarks"),
    "an empty database": (as_empty_database, "no MLflow store; it holds nothing"),
    "of a newer MLflow": (as_newer, "a newer MLflow (version ffffffffffff"),
    "of an older MLflow": (as_older, "an older MLflow"),
    "cut in half": (as_half, "the MLflow store is damaged"),
    "overwritten": (as_overwritten, "the MLflow store is damaged"),
    "a folder": (as_folder, "a folder stands where"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_what_is_no_usable_store_is_named_with_its_fix_and_left_as_it_is(file: Path, fault: str) -> None:
    spoil, says = FAULTS[fault]
    spoil(file)
    before = file.read_bytes() if file.is_file() else None
    with pytest.raises(StoreError, match=re.escape(says)) as error:
        client_of(f"sqlite:///{file}")
    assert error.value.where == str(file)
    assert error.value.fix
    assert (file.read_bytes() if file.is_file() else None) == before
    if before != b"":  # create_store makes one of an empty file
        with pytest.raises(StoreError, match=re.escape(says)):
            create_store(f"sqlite:///{file}")


def test_an_empty_file_is_none_yet_and_mlflow_makes_one_of_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []

    class Client:
        def __init__(self, uri: str) -> None:
            asked.append(uri)

        def search_experiments(self, max_results: int) -> None:
            assert max_results == 1

    monkeypatch.setattr(store, "MlflowClient", Client)
    (tmp_path / "mlflow.db").touch()
    create_store(f"sqlite:///{tmp_path / 'mlflow.db'}")
    assert asked == [f"sqlite:///{tmp_path / 'mlflow.db'}"]


def test_a_store_that_may_not_be_written_says_so(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file.chmod(0o444)
    if os.geteuid() == 0:  # root may write everything
        monkeypatch.setattr(os, "access", lambda path, mode: bool(Path(path).stat().st_mode & 0o200) or mode == os.F_OK)
    with pytest.raises(StoreError, match="may not be read and written") as error:
        check_file(file)
    assert f"chmod u+rw '{file}'" in str(error.value)


def test_sqlites_own_word_for_it_is_the_same(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a file system that is mounted read-only `os.access` may not know."""
    connect = sqlite3.connect
    monkeypatch.setattr(sqlite3, "connect", lambda path, **given: connect(f"file:{path}?mode=ro", uri=True, **given))
    with pytest.raises(StoreError, match="the MLflow store may not be written"):
        check_file(file)


def held(file: Path, seconds: float) -> subprocess.Popen[str]:
    """A process that locks a store for some seconds, when it has."""
    command = [sys.executable, "-c", HOLD, str(file), str(seconds)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "locked\n"
    return process


@pytest.mark.parametrize("journal", ["wal", "delete"])
def test_a_locked_store_is_waited_for(file: Path, journal: str) -> None:
    change(file, f"PRAGMA journal_mode = {journal}")
    with held(file, 1.0) as process:
        started = time.monotonic()
        check_file(file)
        assert time.monotonic() - started > 0.5
        process.wait()


@pytest.mark.parametrize("journal", ["wal", "delete"])
def test_a_store_that_stays_locked_is_one_sentence(file: Path, journal: str) -> None:
    change(file, f"PRAGMA journal_mode = {journal}")
    with held(file, 60) as process:
        with pytest.raises(StoreError, match="another program has held the MLflow store locked for 0 s") as error:
            check_file(file, patience=0.2)
        process.kill()
    assert error.value.where == str(file)
    check_file(file)
