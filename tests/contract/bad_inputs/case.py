from __future__ import annotations

import contextlib
import copy
import io
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from softkin.cli.configuration import check
from softkin.core.config_files import check_config_files
from softkin.core.errors import SoftkinError
from softkin.data.prepare import prepare
from softkin.data.scored_rows import KeptRows
from tests.conftest import HOUSE

SCHEMA = HOUSE / "workflow" / "schemas" / "config.schema.yaml"
DEFAULTS = [HOUSE / "config" / name for name in ("config.yaml", "datasets.yaml")]


@dataclass(frozen=True)
class BadInput:
    """`what` is wrong, in words; `provoke()` makes it in the working directory and hands it to softkin; the message
    `says` each of these.
    """

    what: str
    provoke: Callable[[], Any]
    says: tuple[str, ...]


def answer(case: BadInput, folder: Path) -> SoftkinError:
    """The error that softkin answers with; any other exception passes."""
    folder.mkdir(parents=True, exist_ok=True)
    with contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        try:
            case.provoke()
        except SoftkinError as error:
            return error
    raise AssertionError(f"accepted: {case.what}")


def message(error: SoftkinError, folder: Path) -> str:
    """The text of an answer, without the folders of this machine."""
    return str(error).replace(f"{folder}{os.sep}", "").replace(f"{HOUSE}{os.sep}", "")


@cache
def _defaults() -> dict[str, Any]:
    return {key: value for path in DEFAULTS for key, value in yaml.safe_load(path.read_text()).items()}


def merged(config: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """As Snakemake merges files: key by key."""
    result = dict(config)
    for key, value in other.items():
        nested = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = merged(result[key], value) if nested else value
    return result


def configured(text: str | bytes, **environment: str) -> Callable[[], None]:
    """A run with `--configfile more.yaml`, which holds this text; `environment` holds variables."""

    def provoke() -> None:
        more = Path("more.yaml")
        more.write_bytes(text if isinstance(text, bytes) else text.encode())
        check_config_files([more])
        check_with(yaml.safe_load(more.read_text()), **environment)

    return provoke


def check_with(changes: Mapping[str, Any], **environment: str) -> None:
    """Check the default configuration with these changes."""
    config = merged(copy.deepcopy(_defaults()), changes)
    check(config, schema=SCHEMA, files=[*DEFAULTS, *Path().glob("more.yaml")], environment=environment)


def prepared(content: str | bytes, entry: Mapping[str, Any], max_rows: int | None = None) -> Callable[[], None]:
    """Rule prepare on a file of this content and an entry."""

    def provoke() -> None:
        Path("arm.csv").write_bytes(content if isinstance(content, bytes) else content.encode())
        prepare(
            "arm.csv",
            dataset="arm",
            source={"file": "arm.csv", "title": "Arm", **entry},
            table="table.parquet",
            description="dataset.json",
            kept=KeptRows(first=max_rows),
        )

    return provoke
