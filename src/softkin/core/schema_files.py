"""Read a schema that stands in several files, as one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from softkin.core.config_files import LOADER

#: What a file says of itself, and not of the place that refers to it.
_OF_THE_FILE = ("$schema", "title")


def read_schema(path: str | Path) -> dict[str, Any]:
    """The YAML schema in a file, with the files beside it that it refers to (`$ref: name.yaml`) in these places."""
    file = Path(path)
    schema: dict[str, Any] = _complete(yaml.load(file.read_text(encoding="utf-8"), Loader=LOADER), file.parent)
    return schema


def _complete(node: Any, folder: Path) -> Any:
    """A part of a schema, without references."""
    if isinstance(node, list):
        return [_complete(part, folder) for part in node]
    if not isinstance(node, dict):
        return node
    if set(node) == {"$ref"}:
        part = read_schema(folder / node["$ref"])
        return {key: value for key, value in part.items() if key not in _OF_THE_FILE}
    return {key: _complete(value, folder) for key, value in node.items()}
