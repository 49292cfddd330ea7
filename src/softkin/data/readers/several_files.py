"""The table of a robot in several files: parts of each row that are joined, trials that are sessions, or both."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError
from softkin.data.readers.file_bundle import Unpacked
from softkin.data.readers.joined_tables import JoinedTables
from softkin.data.readers.memory_table import Table
from softkin.data.readers.stacked_tables import StackedTables

logger = logging.getLogger("softkin")

#: Keys that say how a file is read: of the entry for all files, of an item of `files` for one.
READING = ("delimiter", "header", "sheet")


def open_table(path: Path, source: Mapping[str, Any], open_one: Callable[[Path, Mapping[str, Any]], Table]) -> Table:
    """The table of the bundle at `path`, as the keys `files` and `join` of the entry `source` say.

    Parameters:
        path: of a bundle.
        source: the entry.
        open_one: opens the table in one file.

    Raises:
        DataError: a file cannot be read, or the files cannot be joined.
    """
    unpacked = Unpacked(path)
    general = {key: source[key] for key in READING if key in source}

    def opened(item: Any, name: str, file: Path) -> tuple[str, Table]:
        own = {key: item[key] for key in READING if key in item} if isinstance(item, Mapping) else {}
        try:
            return name, open_one(file, general | own | {"file": name})
        except DataError as error:
            raise error.within(f"file {name}") from error

    parts = [
        [opened(item, *file) for file in files] for item, files in zip(source["files"], unpacked.parts, strict=True)
    ]
    if "join" not in source:
        return _stacked([trial for files in parts for trial in files], unpacked)
    joined = [JoinedTables(files, source["join"], unpacked) for files in zip(*parts, strict=True)]
    if len(joined) == 1:
        return joined[0]
    return _stacked([(", ".join(table.files), table) for table in joined], unpacked)


def _stacked(trials: Sequence[tuple[str, Table]], unpacked: Unpacked) -> StackedTables:
    for number, (name, _) in enumerate(trials):
        logger.info("session %d: %s", number + 1, name)
    return StackedTables(trials, unpacked)
