"""Errors of libraries and of the machine as a person needs them: what, where and how to fix it."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable

from softkin.core.damage import first_damage
from softkin.core.errors import DataError, SoftkinError, StoreError
from softkin.core.files import with_listed
from softkin.core.urls import without_credentials

_STORE = (
    "the MLflow store",
    "check `tracking_uri` and, if it is a server, that it runs; or make the store again from results/: make store",
)
_STUDY = (
    "the study",
    "delete the study of this job in results/studies and run again; results that are finished are kept",
)
#: Library -> what it keeps, and what to do when it complains.
LIBRARIES = {"mlflow": _STORE, "sqlalchemy": _STORE, "alembic": _STORE, "sqlite3": _STORE, "optuna": _STUDY}
_URL = re.compile(r"\w+://\S+")


def explained(error: Exception, inputs: Iterable[str | os.PathLike[str]]) -> SoftkinError | None:
    """What ended a job, where it is no defect of softkin: one of its `inputs` is damaged, a library refuses its store,
    a file cannot be written. None where the error explains itself to nobody but a developer.
    """
    try:
        if damage := first_damage(with_listed(inputs)):
            return damage
    except DataError as of_manifest:
        return of_manifest
    library = type(error).__module__.partition(".")[0]
    if library in LIBRARIES:
        where, fix = LIBRARIES[library]
        return StoreError(f"{library} says: {_first_sentence(error)}", where=where, fix=fix)
    if isinstance(error, MemoryError):
        return DataError(
            "the memory of this machine is used up",
            where="this job",
            fix="run fewer jobs at a time with --cores 1, or lower max_rows_per_subset",
        )
    if isinstance(error, OSError) and error.strerror:
        return DataError(
            error.strerror.lower(),
            where=error.filename or "this job",
            fix="check that the disk has space and that the file may be read and written, and run again",
        )
    return None


def _first_sentence(error: Exception) -> str:
    """The first line of a message, without the credentials of the URLs in it."""
    line = next((line.strip() for line in str(error).splitlines() if line.strip()), type(error).__name__)
    return _URL.sub(lambda url: without_credentials(url[0]), line)[:300]
