"""The files of a new robot: one, trials, or parts of each row; and how the parts are probably joined."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softkin.cli.guess_join import guess_join
from softkin.core.errors import DataError
from softkin.data import own_files
from softkin.data.readers.file_bundle import write_bundle
from softkin.data.readers.memory_table import Table
from softkin.data.readers.table_formats import open_table


@dataclass(frozen=True, slots=True)
class RobotFiles:
    """What a person named: the `path` that is read, a file or a bundle of several; `file`, how it is called; keys of
    the entry that say how it is read, `options`; and a sentence on each that was guessed, `reasons`.
    """

    path: Path
    file: str
    options: dict[str, Any]
    reasons: list[str]

    def entry(self, guessed: Mapping[str, Any]) -> dict[str, Any]:
        """A guessed entry with what it names: `file`, or `files`."""
        return {key: value for key, value in guessed.items() if not (key == "file" and "files" in self.options)}


@contextmanager
def robot_files(names: Sequence[str], options: Mapping[str, Any], join: str | None = None) -> Iterator[RobotFiles]:
    """The files of these `names`, paths or patterns; those of several are in a bundle as long as the block goes on.

    Files of the same columns are trials, one below the other; others are parts of each row.

    Parameters:
        names: paths or patterns, such as `trial_*.csv`.
        options: keys of the entry that say how each file is read.
        join: how parts are joined, a name of `JOINS`; None: it is guessed.

    Raises:
        DataError: there is no such file, or it cannot be read, or nothing tells how parts belong together.
    """
    found = [own_files.matching(name) for name in names]
    for name, files in zip(names, found, strict=True):
        if not files or not all(Path(file).is_file() for file in files):
            fix = "name the robot's file: make new-robot FILE=..."
            if name and Path(name).is_dir():
                fix = f"that is a folder; name a file in it, or a pattern of trials: make new-robot FILE='{name}/*.csv'"
            raise DataError(f"no such file: '{name}'", where="FILE", fix=fix)
    if len(found) == 1 and found[0] == [names[0]]:
        yield RobotFiles(Path(names[0]), _called(names[0]), dict(options), [])
        return
    called = [_called(name) for name in names]
    tables = [[_opened(file, options) for file in files] for files in found]
    columns = {tuple(sorted(table.names)) for part in tables for table in part}
    reasons: list[str] = []
    keys: dict[str, Any] = {**options, "files": called}
    if join is None and (len(columns) == 1 or len(tables) == 1):
        reasons.append(f"files: {sum(map(len, found))} files of the same columns, so trials; each is a session")
    else:
        keys["join"], reasons = guess_join(list(zip(called, (part[0] for part in tables), strict=True)), join)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "raw"
        write_bundle(own_files.parts({**keys, "files": list(names)}), path)
        file = own_files.in_words(keys)
        try:
            yield RobotFiles(path, file, keys, reasons)
        except DataError as error:
            where = None if error.where is None else error.where.replace(str(path), file)
            raise DataError(error.what, where=where, fix=error.fix) from error


def _opened(file: str, options: Mapping[str, Any]) -> Table:
    try:
        return open_table(file, {**options, "file": file})
    except DataError as error:
        raise error.within(file) from error


def _called(name: str) -> str:
    """The path as the entry names it: from the working directory where it is below it, otherwise the whole path."""
    path = Path(os.path.abspath(name))
    return path.relative_to(Path.cwd()).as_posix() if path.is_relative_to(Path.cwd()) else str(path)
