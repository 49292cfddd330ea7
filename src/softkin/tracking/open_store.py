"""Whether an MLflow store in a file can be used at all: told before MLflow opens it, in words that say what to do."""

from __future__ import annotations

import os
import sqlite3
from contextlib import closing
from functools import cache
from pathlib import Path

import mlflow
from alembic.script import ScriptDirectory

from softkin.core.errors import StoreError

#: Seconds that another program may hold a store locked.
LOCKED = 120.0
#: Tables that every store of MLflow has.
TABLES = {"experiments", "runs", "alembic_version"}
OTHER = "move the file away and make the store again from results/: make store; or name another one in tracking_uri"


def check_file(file: Path, patience: float = LOCKED) -> None:
    """Check a store in a file, which another program may hold locked for `patience` seconds.

    Raises:
        StoreError: it is damaged, no database or none of MLflow's, of another version, read-only, or locked for longer.
    """
    if not file.is_file():
        raise StoreError("a folder stands where the MLflow store should be", where=file, fix=OTHER)
    if not os.access(file, os.R_OK | os.W_OK):
        fix = f"give the right to read and write it, by chmod u+rw '{file}'; results that are finished are kept"
        raise StoreError("the MLflow store may not be read and written", where=file, fix=fix)
    try:
        with closing(sqlite3.connect(file, timeout=patience, isolation_level=None)) as connection:
            tables = {name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
            if not tables >= TABLES:
                held = ", ".join(sorted(tables)[:3]) or "nothing"
                raise StoreError(f"this database is no MLflow store; it holds {held}", where=file, fix=OTHER)
            _check_version(file, connection.execute("SELECT version_num FROM alembic_version").fetchone())
            connection.execute("BEGIN IMMEDIATE")
            connection.execute("UPDATE alembic_version SET version_num = version_num")
            connection.execute("ROLLBACK")
    except sqlite3.Error as error:
        raise _refused(file, error, patience) from error


def _check_version(file: Path, found: tuple[str] | None) -> None:
    """Raise where a store is of an older or newer MLflow."""
    version = found[0] if found else "none"
    known = _versions()
    if version == known[0]:
        return
    if version in known:
        raise StoreError(
            f"this store was made by an older MLflow (version {version} of its tables)",
            where=file,
            fix=f"copy the file, then bring it up to date: .venv/bin/mlflow db upgrade 'sqlite:///{file}'",
        )
    raise StoreError(
        f"this store was made by a newer MLflow (version {version} of its tables, unknown to {mlflow.__version__})",
        where=file,
        fix="install the MLflow that made it, or name another store in tracking_uri",
    )


@cache
def _versions() -> list[str]:
    """The versions of tables that the installed MLflow knows, the newest first."""
    scripts = ScriptDirectory(str(Path(mlflow.__file__).parent / "store" / "db_migrations"))
    return [script.revision for script in scripts.walk_revisions()]


def _refused(file: Path, error: sqlite3.Error, patience: float) -> StoreError:
    """What SQLite refuses, in words."""
    said = str(error)
    if "locked" in said:
        return StoreError(
            f"another program has held the MLflow store locked for {patience:.0f} s",
            where=file,
            fix="end that program, such as a database browser, and run again; results that are finished are kept",
        )
    if "readonly" in said or "read-only" in said:
        return StoreError(
            "the MLflow store may not be written",
            where=file,
            fix=f"give the right to write there, by chmod u+rw '{file}'; results that are finished are kept",
        )
    if "not a database" in said:
        return StoreError("this file is no database", where=file, fix=OTHER)
    return StoreError(f"the MLflow store is damaged: {said}", where=file, fix=OTHER)
