"""MLflow stores without a run: making one takes seconds, copying it none."""

from __future__ import annotations

import sqlite3
import tempfile
from contextlib import closing
from functools import cache
from pathlib import Path

from softkin.tracking.store import create_store


@cache
def _empty() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        made, copied = Path(folder) / "made.db", Path(folder) / "copied.db"
        create_store(f"sqlite:///{made}")
        with closing(sqlite3.connect(made)) as empty, closing(sqlite3.connect(copied)) as copy:
            empty.backup(copy)
        return copied.read_bytes()


def new_store(path: Path) -> str:
    """The address of a store at `path`, as `create_store` makes one there."""
    path.write_bytes(_empty())
    return f"sqlite:///{path}"
