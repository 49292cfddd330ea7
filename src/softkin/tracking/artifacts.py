"""Where the artifacts of runs lie: as the store says, and as it should be in a project that was moved or copied.

A store in a file holds the absolute locations of its artifacts. In a project that was moved they are wrong; in one that
was copied they are the original's, and whatever is logged would go there.
"""

from __future__ import annotations

import logging
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from urllib.parse import quote, unquote, urlsplit

from mlflow import MlflowClient
from mlflow.entities import Run

logger = logging.getLogger("softkin")

#: The folder of artifacts beside a store in a file; a server has its own place for them.
FOLDER = "mlartifacts"
#: The columns of MLflow's database that hold locations of artifacts: table -> column.
LOCATIONS = {
    "experiments": "artifact_location",
    "runs": "artifact_uri",
    "logged_models": "artifact_location",
    "model_versions": "storage_location",
}


def move_locations(database: str | Path) -> None:
    """Make the locations in a store that was moved or copied those in the folder `mlartifacts` beside it.

    An experiment whose artifacts are where the store says, and not beside it, stays as it is.

    Parameters:
        database: file of the store, SQLite.
    """
    beside = artifacts_beside(database)
    with closing(sqlite3.connect(database)) as connection, connection:
        known = connection.execute("SELECT name, artifact_location FROM experiments").fetchall()
        for name, old in known:
            new = beside / name
            if old == new.as_uri() or not old.endswith(f"/{quote(name)}"):
                continue
            if new.exists() or not folder_of(old).exists():
                for table, column in LOCATIONS.items():
                    connection.execute(
                        f"UPDATE {table} SET {column} = ? || substr({column}, ?) "
                        f"WHERE {column} = ? OR {column} LIKE ? ESCAPE '!'",
                        (new.as_uri(), len(old) + 1, old, f"{_literally(old)}/%"),
                    )
                logger.info("the artifacts of %s were in %s; they are in %s now", name, old, new)


def artifacts_beside(database: str | Path) -> Path:
    """The folder that holds the artifacts of a store in a file."""
    return Path(database).resolve().parent / FOLDER


def folder_of(uri: str) -> Path:
    """The folder that a file:// location stands for."""
    return Path(unquote(urlsplit(uri).path))


def are_there(client: MlflowClient, run: Run, names: Sequence[str], figures: Sequence[str]) -> bool:
    """Whether the artifacts of a run are where the store has them: those of these names, and in the folder of figures
    those of these.
    """
    if urlsplit(str(run.info.artifact_uri)).scheme == "file":
        folder = folder_of(str(run.info.artifact_uri))
        return all((folder / name).exists() for name in (*names, *(f"figures/{name}" for name in figures)))
    return _listed(client, run, names, None) and _listed(client, run, figures, "figures")


def _listed(client: MlflowClient, run: Run, names: Sequence[str], folder: str | None) -> bool:
    """Whether a server has artifacts of these names."""
    if not names:
        return True
    there = {Path(file.path).name for file in client.list_artifacts(run.info.run_id, folder)}
    return there >= set(names)


def _literally(text: str) -> str:
    """A pattern of SQL's LIKE that stands for the text itself."""
    return text.replace("!", "!!").replace("%", "!%").replace("_", "!_")
