"""Write files in one step, so that a reader never sees half of one; read JSON; hash files."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from softkin.core.damage import damaged
from softkin.core.strict_json import NotStrictJson, parse_json

#: The name of a file that stands for others: in the folder of a model, whose presets have a folder each, and in that of
#: intervals (`core.manifest`).
MANIFEST = "manifest.json"


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary path beside `path`; when the block succeeds it is on the disk, then renamed into place; it is
    deleted otherwise. So a power cut leaves the old file or the new one.
    """
    final = Path(path)
    final.parent.mkdir(parents=True, exist_ok=True)
    temporary = final.with_name(f".{final.name}.{os.getpid()}.part")
    try:
        yield temporary
        _to_disk(temporary)
        os.replace(temporary, final)
        _to_disk(final.parent)
    finally:
        temporary.unlink(missing_ok=True)


def _to_disk(path: Path) -> None:
    """Wait until a file, or the names in a folder, are on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write `text` in one step."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_json(path: str | os.PathLike[str], value: Any) -> None:
    """Write `value` as indented JSON in one step; NaN and infinity are refused."""
    write_text(path, json.dumps(value, indent=2, allow_nan=False) + "\n")


def read_json(path: str | os.PathLike[str]) -> Any:
    """Read a JSON file that softkin wrote.

    Raises:
        DataError: it is cut off, or something else.
    """
    try:
        return parse_json(Path(path).read_text(encoding="utf-8"))
    except (NotStrictJson, UnicodeDecodeError) as error:
        raise damaged(path, str(error)) from error


def file_sha256(path: str | os.PathLike[str]) -> str:
    """SHA-256 (hex) of the content of one file, read piece by piece."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sha256_of(paths: Iterable[str | Path]) -> str:
    """SHA-256 (hex) over the contents of `paths`, each with its file name and size, in that order."""
    digest = hashlib.sha256()
    for path in map(Path, paths):
        content = path.read_bytes()
        digest.update(f"{path.name}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()


def with_listed(paths: Iterable[str | os.PathLike[str]]) -> Iterator[Path]:
    """The paths, each manifest among them followed by the files that it holds."""
    for path in map(Path, paths):
        yield path
        if path.name == MANIFEST and path.is_file():
            yield from (path.parent / name for name in read_json(path))
