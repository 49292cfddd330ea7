"""Which published datasets can be reached now, and what stands in for the others."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import urlparse

import requests

PROBE_SECONDS = 4.0
SUFFIX = "_standin"
#: Keys of an entry that speak of the published data only.
PUBLISHED_ONLY = ("urls", "sha256", "licence", "citation", "paper_table", "paper_params", "notes", "clean")
HOW_TO_GET_THEM = (
    "put the published files into a folder and name it in SOFTKIN_DATA_MIRROR, or run where their authors' repository "
    "can be reached"
)


def is_in_reach(entry: Mapping[str, Any], mirror: str | None) -> bool:
    """Whether the mirror has the file or one of its URLs answers; nothing is downloaded."""
    return any(_answers(place) for place in _places(entry, mirror))


def stand_in_entry(entry: Mapping[str, Any]) -> dict[str, Any]:
    """The entry of the simulated robot in place of a published dataset's `entry`."""
    kept = {key: value for key, value in entry.items() if key not in (*PUBLISHED_ONLY, "standin")}
    robot = entry["standin"]["robot"]
    return kept | {
        "title": f"STAND-IN for {entry['title']}: simulated by softkin",
        "format": "simulated",
        "file": f"the simulation of {robot}",
        "position_unit": "mm",
        **entry["standin"],
    }


def with_stand_ins(
    datasets: Iterable[str],
    sources: Mapping[str, Mapping[str, Any]],
    *,
    mirror: str | None,
    retrieved: Mapping[str, Path],
) -> tuple[list[str], dict[str, Any], list[str]]:
    """Datasets and sources in which every published dataset out of reach is replaced by its stand-in, under a name of
    its own, and the names of those that were replaced.

    One that was `retrieved` before (dataset -> file) is in reach, and so is one without `standin` in its entry, since
    there is nothing to replace it by.
    """
    names, entries, replaced = [], {name: dict(entry) for name, entry in sources.items()}, []
    for name in datasets:
        entry = entries[name]
        if "standin" not in entry or retrieved[name].exists() or is_in_reach(entry, mirror):
            names.append(name)
            continue
        replaced.append(name)
        names.append(name + SUFFIX)
        entries[name + SUFFIX] = stand_in_entry(entry)
    return names, entries, replaced


def warning(replaced: Iterable[str]) -> str:
    """What a person must be told, in one paragraph."""
    names = ", ".join(replaced)
    return (
        f"STAND-INS: {names} cannot be reached. Robots simulated by softkin take their place, as <name>{SUFFIX}; they "
        "are not the published data, and nothing is compared with the paper. For the real ones, "
        f"{HOW_TO_GET_THEM}: the next run takes them by itself."
    )


def _places(entry: Mapping[str, Any], mirror: str | None) -> Iterator[str]:
    if mirror:
        yield f"{mirror.rstrip('/')}/{entry['file']}"
    yield from entry.get("urls", ())


def _answers(place: str) -> bool:
    if urlparse(place).scheme not in ("http", "https"):
        return Path(place).is_file()
    try:
        return requests.head(place, timeout=PROBE_SECONDS, allow_redirects=True).ok
    except requests.RequestException:
        return False
