"""Addresses of stores, mirrors and downloads that lead nowhere."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tests.contract.bad_inputs.case import BadInput, check_with, configured


def store_in(path: str, make: Callable[[Path], object]) -> Callable[[], None]:
    def provoke() -> None:
        make(Path(path))
        check_with({"tracking_uri": f"sqlite:///{path}"})

    return provoke


def mirror_file() -> None:
    Path("FINGER.json").write_text("{}")
    check_with({"data_mirror": "FINGER.json"})


STORE = "tracking_uri"
CASES = [
    BadInput("an empty store", configured("tracking_uri: ''"), (STORE,)),
    BadInput("a folder as store", configured("tracking_uri: mlruns"), (STORE, "MLflow takes no more")),
    BadInput("a file: store", configured("tracking_uri: 'file:mlruns'"), (STORE, "MLflow takes no more")),
    BadInput("an unknown scheme", configured("tracking_uri: 'ftp://host/store'"), (STORE, "unknown scheme 'ftp'")),
    BadInput("SQLite with two slashes", configured("tracking_uri: sqlite://mlflow.db"), (STORE, "three slashes")),
    BadInput("SQLite in memory", configured("tracking_uri: 'sqlite:///:memory:'"), (STORE, "kept in memory")),
    BadInput("SQLite without a file", configured("tracking_uri: 'sqlite:///'"), (STORE, "kept in memory")),
    BadInput(
        "SQLite in a folder that is not there", configured("tracking_uri: sqlite:///no/db"), ("make that folder",)
    ),
    BadInput(
        "SQLite below a file", store_in("note/db", lambda path: path.parent.write_text("")), (STORE, "is no folder")
    ),
    BadInput("a folder as database", store_in("stores", lambda path: path.mkdir()), (STORE, "is a folder")),
    BadInput("another file as database", store_in("a.db", lambda path: path.write_text("hello")), ("no SQLite",)),
    BadInput("a server without a name", configured("tracking_uri: 'http://'"), (STORE, "names no server")),
    BadInput("a port that is none", configured("tracking_uri: 'http://host:99999'"), (STORE, "names no server")),
    BadInput(
        "a database without its driver",
        configured("tracking_uri: mssql://me:secret@host/db"),
        ("mssql://***@host/db", "package pyodbc"),
    ),
    BadInput(
        "an unknown scheme in the environment",
        configured("seed: 1", MLFLOW_TRACKING_URI="redis://host"),
        ("variable MLFLOW_TRACKING_URI", "unknown scheme 'redis'"),
    ),
    BadInput("an empty mirror", configured("data_mirror: ''"), ("data_mirror: an empty text",)),
    BadInput("a mirror of an unknown scheme", configured("data_mirror: s3://data"), ("unknown scheme 's3'",)),
    BadInput("a mirror without a server", configured("data_mirror: 'https://'"), ("names no server",)),
    BadInput("a file as mirror", mirror_file, ("FINGER.json is a file", "name the folder")),
    BadInput("a mirror that is a number", configured("data_mirror: 7"), ("data_mirror: 7 is no text",)),
    BadInput(
        "a mirror of an unknown scheme in the environment",
        configured("seed: 1", SOFTKIN_DATA_MIRROR="gopher://x"),
        ("variable SOFTKIN_DATA_MIRROR", "gopher"),
    ),
]
