"""The files of a robot of one's own, as its entry names them: one under `file`, or several under `files`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from glob import glob, has_magic
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError


def named(entry: Mapping[str, Any]) -> list[str]:
    """What the entry names, patterns as they are."""
    if "files" not in entry:
        return [entry["file"]]
    return [item if isinstance(item, str) else item["file"] for item in entry["files"]]


def in_words(entry: Mapping[str, Any]) -> str:
    """What the entry names, for messages and tables."""
    return ", ".join(named(entry))


def listed(entry: Mapping[str, Any]) -> list[str]:
    """All files that the entry names; a pattern that matches none stays as it is."""
    if "files" not in entry:
        return named(entry)
    return [file for name in named(entry) for file in matching(name) or [name]]


def parts(entry: Mapping[str, Any]) -> list[list[str]]:
    """The files that each item of `files` names, or `file`. With `join` the items are parts of each row, and the files
    that a pattern matches are trials; without it all files are trials.

    Raises:
        DataError: a pattern matches no file, or parts have different numbers of trials.
    """
    names = named(entry)
    found = [matching(name) if "files" in entry else [name] for name in names]
    counted = list(zip(names, map(len, found), strict=True))
    for name, count in counted:
        if not count:
            raise DataError(f"no file is named like '{name}'", where="`files`", fix="correct the pattern or the path")
    if "join" in entry and len({count for _, count in counted}) > 1:
        raise DataError(
            f"parts of different numbers of trials: {', '.join(f'{count} of {name}' for name, count in counted)}",
            where="`files`",
            fix="name as many files of each part, in names that sort alike",
        )
    return found


def matching(name: str) -> list[str]:
    """The files that a path or a pattern names, numbers in their names in the order of numbers: 2 before 10."""
    if not has_magic(name) or Path(name).exists():
        return [name]
    return sorted((path for path in glob(name) if Path(path).is_file()), key=_by_numbers)


def are_there(entry: Mapping[str, Any], folder: Path) -> bool:
    """Whether all files that the entry names are there, paths from `folder`."""
    names = [str(folder / name) for name in named(entry)]
    if "files" not in entry:
        return Path(names[0]).exists()
    return all(any(Path(file).exists() for file in matching(name)) for name in names)


def _by_numbers(name: str) -> list[tuple[int, str]]:
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"(\d+)", name)]
