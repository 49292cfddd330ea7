"""Results that are cut off or garbage when a later job reads them, and what libraries and the machine refuse."""

from __future__ import annotations

import errno
import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
import sqlalchemy
from mlflow.exceptions import MlflowException
from optuna.exceptions import DuplicatedStudyError

from softkin.core.damage import check_ends
from softkin.core.explained import explained
from softkin.core.files import read_json
from softkin.core.run_archive import RunArchive, read_run_archive
from softkin.core.runs import Run
from tests.contract.bad_inputs.case import BadInput
from tests.contract.bad_inputs.tables import frame

GARBAGE = b"\x80\x04garbage" * 50


def in_a_job(read: Callable[[Path], Any], path: Path) -> None:
    """As `softkin.core.job.job` does it around a script that reads its input."""
    try:
        check_ends([path])
        read(path)
    except Exception as error:
        known = explained(error, [path])
        if known is None:
            raise
        raise known from error


def whole(name: str) -> bytes:
    """A good result file of that name."""
    buffer = io.BytesIO()
    if name.endswith(".parquet"):
        frame().to_parquet(buffer)
    elif name.endswith(".joblib"):
        joblib.dump({"coefficients": np.arange(5000.0)}, buffer, compress=3)
    elif name.endswith(".npz"):
        archive = Path("whole.npz")
        RunArchive({"a": np.arange(900.0)}, {(Run("lr", "paper"), "0"): np.arange(900.0)}).write(archive)
        return archive.read_bytes()
    elif name.endswith(".csv"):
        return str(frame(50).to_csv(index=False)).encode()
    else:
        return b'{\n  "params": {},\n  "cv_mae_mm": 1.0\n}\n'
    return buffer.getvalue()


READERS: dict[str, Callable[[Path], Any]] = {
    "predictions.parquet": pd.read_parquet,
    "model.joblib": joblib.load,
    "refits.npz": read_run_archive,
    "interval_metrics.csv": pd.read_csv,
    "parameters.json": read_json,
}


def damaged(name: str, spoil: Callable[[bytes], bytes]) -> Callable[[], None]:
    def provoke() -> None:
        path = Path("results") / "finger" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(spoil(whole(name)))
        in_a_job(READERS[name], path)

    return provoke


def raising(error: Exception) -> Callable[[], None]:
    def read(_: Path) -> None:
        raise error

    return lambda: in_a_job(read, Path("results/finger/table.parquet"))


def ways(name: str) -> list[BadInput]:
    says = (f"results/finger/{name}", "damaged", "delete the file and run again")
    # Without the last byte, a check sum, the numbers of a compressed model are still whole.
    short = [BadInput(f"{name}, one byte short", damaged(name, lambda content: content[:-1]), says)]
    return [
        BadInput(f"{name}, cut in half", damaged(name, lambda content: content[: len(content) // 2]), says),
        *(short if name != "model.joblib" else []),
        BadInput(f"{name}, empty", damaged(name, lambda _: b""), says),
        BadInput(f"{name}, garbage", damaged(name, lambda _: GARBAGE), says),
    ]


CASES = [
    *(case for name in READERS for case in ways(name)),
    BadInput(
        "a row of interval_metrics.csv cut, others after it",
        damaged("interval_metrics.csv", lambda content: content.replace(b",", b"\n", 9)),
        ("interval_metrics.csv", "damaged", "line"),
    ),
    BadInput(
        "MLflow's server is gone",
        raising(MlflowException("API request to http://me:secret@host failed\nTraceback of a server")),
        ("the MLflow store: mlflow says: API request to http://***@host failed", "check `tracking_uri`"),
    ),
    BadInput(
        "a database that is locked",
        raising(sqlalchemy.exc.OperationalError("select 1", {}, Exception("database is locked"))),
        ("the MLflow store", "database is locked", "make store"),
    ),
    BadInput(
        "a study that Optuna refuses",
        raising(DuplicatedStudyError("Another study exists.")),
        ("the study: optuna says: Another study exists.", "results/studies"),
    ),
    BadInput(
        "a full disk",
        raising(OSError(errno.ENOSPC, "No space left on device", "results/finger/table.parquet")),
        ("results/finger/table.parquet: no space left on device", "check that the disk has space"),
    ),
    BadInput(
        "a folder that may not be written",
        raising(PermissionError(errno.EACCES, "Permission denied", "results/finger")),
        ("results/finger: permission denied", "may be read and written"),
    ),
    BadInput("memory that is used up", raising(MemoryError()), ("memory", "--cores 1")),
]
