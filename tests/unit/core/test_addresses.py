from __future__ import annotations

import os
import sqlite3
from pathlib import Path

import pytest

from softkin.core.addresses import problems_of_mirror, problems_of_store, problems_of_url


@pytest.mark.parametrize("uri", ["http://127.0.0.1:5000", "https://me:secret@host/mlflow", "sqlite:///mlflow.db"])
def test_a_store_that_may_be_there_has_no_problem(uri: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert list(problems_of_store(uri)) == []


def test_a_database_that_is_there_has_no_problem(tmp_path: Path) -> None:
    path = tmp_path / "my store.db"
    with sqlite3.connect(path) as connection:
        connection.execute("create table a (b)")
    connection.close()
    assert list(problems_of_store(f"sqlite:///{path}")) == []
    path.write_bytes(b"")  # SQLite fills an empty file
    assert list(problems_of_store(f"sqlite:///{path}")) == []


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_database_that_may_not_be_written_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "store.db"
    path.touch(mode=0o444)
    assert "may not be written" in next(iter(problems_of_store(f"sqlite:///{path}")))


def test_a_driver_that_is_named_is_looked_for() -> None:
    (problem,) = problems_of_store("postgresql+nodriver://me:secret@host/db")
    assert "package nodriver" in problem
    assert "secret" not in problem


@pytest.mark.parametrize("mirror", ["data", "/nowhere/data", "file:///data", "https://host/data"])
def test_a_mirror_that_may_be_there_has_no_problem(mirror: str) -> None:
    assert list(problems_of_mirror(mirror)) == []


def test_urls_are_told_from_what_is_none() -> None:
    assert list(problems_of_url("https://host/a%20b.json", "urls.0")) == []
    for url in ("host/a.json", "ftp://host/a", "https:///a", "https://host/a b", "https://[host/a", ""):
        assert next(iter(problems_of_url(url, "urls.0"))).startswith("urls.0: ")


def test_a_password_is_not_shown() -> None:
    told = [*problems_of_store("ftp://me:secret@host/db"), *problems_of_mirror("s3://me:secret@host")]
    told += problems_of_url("ftp://me:secret@host/a?token=secret", "urls.0")
    assert len(told) == 3
    assert all("host" in sentence and "secret" not in sentence for sentence in told)
