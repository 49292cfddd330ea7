"""Several files in one: what `results/<robot>/raw` is of a robot in several files, so that a run keeps what it was made
from. An uncompressed zip file, the same to the bit for the same files; its first member says what they are called.
"""

from __future__ import annotations

import json
import shutil
import tempfile
import weakref
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError

CONTENT = "softkin_files.json"


def write_bundle(parts: Sequence[Sequence[str]], path: str | Path) -> None:
    """Write the files of all parts, trial by trial, to a bundle at `path`.

    Raises:
        OSError: a file cannot be read.
    """
    with zipfile.ZipFile(path, "w") as bundle:
        bundle.writestr(zipfile.ZipInfo(CONTENT), json.dumps({"parts": [list(files) for files in parts]}))
        for part, files in enumerate(parts):
            for trial, file in enumerate(files):
                about = zipfile.ZipInfo(_member(part, trial))
                about.file_size = Path(file).stat().st_size
                with open(file, "rb") as source, bundle.open(about, "w") as to:
                    shutil.copyfileobj(source, to)


def is_bundle(start: bytes) -> bool:
    """Whether a file begins as a bundle does."""
    return start.startswith(b"PK\x03\x04") and start[30:].startswith(CONTENT.encode())


class Unpacked:
    """The files of a bundle in a folder of their own, which goes when this does: `parts` are (name, path) of the files
    of each part, trial by trial.
    """

    def __init__(self, path: Path) -> None:
        """Unpack the bundle at `path`.

        Raises:
            DataError: it is damaged.
        """
        folder = tempfile.mkdtemp(prefix="softkin-")
        self._end = weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        try:
            with zipfile.ZipFile(path) as bundle:
                content: dict[str, Any] = json.loads(bundle.read(CONTENT))
                self.parts = [
                    [(name, Path(bundle.extract(_member(part, trial), folder))) for trial, name in enumerate(names)]
                    for part, names in enumerate(content["parts"])
                ]
        except (zipfile.BadZipFile, KeyError, TypeError, ValueError, OSError) as error:
            raise DataError(f"not readable as a bundle of files: {error}", fix="delete it and run again") from error


def _member(part: int, trial: int) -> str:
    return f"{part}/{trial}"
