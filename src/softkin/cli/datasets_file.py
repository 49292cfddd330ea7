"""Append a robot's entry to config/datasets.yaml as text: comments and layout of the file stay as they are."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from softkin.core.errors import ConfigError
from softkin.core.escaping import one_line
from softkin.core.files import write_text


def entry_text(name: str, entry: Mapping[str, Any], reasons: Sequence[str]) -> str:
    """The entry as a part of config/datasets.yaml, below its reasons as comments."""
    text = yaml.safe_dump({name: entry}, sort_keys=False, allow_unicode=True, default_flow_style=None, width=110)
    lines = [f"# {one_line(reason)}" for reason in reasons]
    return textwrap.indent("\n".join([*lines, text]), "  ")


def append_entry(path: Path, name: str, text: str) -> None:
    """Append `text`, the YAML of the entry `name`, to the file of datasets at `path`; all that it holds stays.

    Raises:
        ConfigError: the name is taken, or the file would not say the same as before plus the entry.
    """
    before = path.read_text(encoding="utf-8")
    after = before.rstrip("\n") + "\n" + text
    entries = read_key(before, path, "sources", dict)
    if name in entries:
        raise ConfigError(f"there is an entry '{name}' already", where=path, fix="choose another name with --name")
    try:
        is_kept = read_key(after, path, "sources", dict) == entries | yaml.safe_load(text)
    except ConfigError:
        is_kept = False
    if not is_kept:
        raise ConfigError(
            "`sources` is not its last key, or its entries are not indented by two",
            where=path,
            fix="put the shown text under `sources` by hand",
        )
    write_text(path, after)


def read_key(text: str, path: Path, key: str, kind: type) -> Any:
    """The value, of type `kind`, of a top-level `key` of the YAML `text` of the file at `path`.

    Raises:
        ConfigError: no YAML, no such key, or a value of another type.
    """
    try:
        value = yaml.safe_load(text)[key]
    except (yaml.YAMLError, TypeError, KeyError) as error:
        reason = " ".join(str(error).split())
        raise ConfigError(f"no YAML with the key `{key}`: {reason}", where=path, fix="correct the file") from error
    if not isinstance(value, kind):
        raise ConfigError(f"`{key}` is no {kind.__name__}", where=path, fix="correct the file")
    return value
