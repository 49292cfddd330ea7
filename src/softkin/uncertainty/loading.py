"""Load a calibrated model: its hash is checked before anything in it runs."""

from __future__ import annotations

import hashlib
import io
import os
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import joblib

from softkin.core.errors import ResultError
from softkin.core.job_records import check_recorded, recorded_sha256
from softkin.uncertainty.calibrated_model import CalibratedModel

#: What unpickling raises where classes have moved, or the file is none or cut off.
UNREADABLE = (AttributeError, ImportError, TypeError, ValueError, KeyError, IndexError, EOFError, OSError)


def load(path: str | Path, *, sha256: str | None = None, trust: bool = False) -> CalibratedModel:
    """The calibrated model in a file, `softkin.load("results/finger/calibrated_model.joblib")`.

    Loading runs what is in the file. Where it lies in a project, its hash must be the one that its job recorded. A file
    that was taken elsewhere has no record: then the hash has to be given, or the file to be trusted.

    Parameters:
        path: of the file (joblib).
        sha256: the hash (hex) that the file must have, from whoever made it; None: the record's alone.
        trust: load a file without a record and without a hash; by default it is refused.

    Raises:
        ResultError: no path or file; another hash; no record, hash or trust; of another version of softkin; no model.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise ResultError(f"{path!r} is no path", where="softkin.load", fix="name the calibrated_model.joblib of a run")
    file = Path(path)
    if not file.is_file():
        raise ResultError("no such file", where=path, fix="name the calibrated_model.joblib of a finished run")
    content = file.read_bytes()
    digest = hashlib.sha256(content).hexdigest()
    if sha256 is not None and digest != sha256.strip().lower():
        raise ResultError(
            f"its sha256 is {digest}, not the one that was given; it is not loaded",
            where=path,
            fix="get the file again from where the hash came from",
        )
    recorded = recorded_sha256(file)
    if recorded is not None:
        check_recorded(path, digest, recorded)
    elif sha256 is None and not trust:
        raise ResultError(
            "no record beside it says who wrote it; it is not loaded, since loading runs what is in it",
            where=path,
            fix="pass the sha256 that its maker names, or trust=True if you made it yourself",
        )
    robot = _unpickled(file, content)
    if not isinstance(robot, CalibratedModel):
        raise ResultError(
            f"it holds no calibrated model, but a {type(robot).__name__}",
            where=path,
            fix="name the calibrated_model.joblib of a finished run",
        )
    made = datetime.fromtimestamp(file.stat().st_mtime, UTC).date().isoformat()
    return replace(robot, about={**robot.about, "date": made})


def _unpickled(file: Path, content: bytes) -> Any:
    """What is in a file; it was written by this version of softkin."""
    try:
        return joblib.load(io.BytesIO(content))
    except ResultError as error:
        raise error if error.where else error.within(str(file)) from error
    except UNREADABLE as error:
        raise ResultError(
            f"it cannot be read by this version of softkin ({type(error).__name__}: {error})",
            where=file,
            fix="make it again with this version, or use the version that wrote it",
        ) from error
