"""Which published datasets can be reached now, and the stand-ins that take the place of the others."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import urlparse

from softkin.core.errors import RetrievalError

PROBE_SECONDS = 4.0
SUFFIX = "_standin"
#: Keys of an entry that are about the published data only.
PUBLISHED_ONLY = ("urls", "sha256", "licence", "citation", "paper_table", "paper_params", "notes", "clean")


def is_reachable(entry: Mapping[str, Any], mirror: str | None) -> bool:
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


def out_of_reach(
    datasets: Iterable[str],
    sources: Mapping[str, Mapping[str, Any]],
    *,
    mirror: str | None,
    retrieved: Mapping[str, Path],
) -> list[str]:
    """Which `datasets` cannot be had now, and have a stand-in.

    A dataset that was `retrieved` before (dataset -> file) can be had, and so can one without `standin` in its entry.
    """
    return [
        name
        for name in datasets
        if "standin" in sources[name] and not retrieved[name].exists() and not is_reachable(sources[name], mirror)
    ]


def with_stand_ins(
    datasets: Iterable[str], sources: Mapping[str, Mapping[str, Any]], replaced: Collection[str]
) -> tuple[list[str], dict[str, Any]]:
    """(datasets, sources): each dataset that is `replaced` has its stand-in there, under a name of its own."""
    entries = {name: dict(entry) for name, entry in sources.items()}
    entries |= {name + SUFFIX: stand_in_entry(sources[name]) for name in replaced}
    return [name + SUFFIX if name in replaced else name for name in datasets], entries


def warning(replaced: Iterable[str]) -> str:
    """The warning that stand-ins take the place of the datasets `replaced`, and how to get the published data."""
    error = RetrievalError(
        f"{', '.join(replaced)} cannot be reached. Robots simulated by softkin take their place, as <name>{SUFFIX}; "
        "they are not the published data, and nothing is compared with the paper.",
        where="STAND-INS",
        fix="put the published files into a folder and name it in SOFTKIN_DATA_MIRROR, or run where their authors' "
        "repository can be reached; the next run uses them",
    )
    return str(error)


def _places(entry: Mapping[str, Any], mirror: str | None) -> Iterator[str]:
    if mirror:
        yield f"{mirror.rstrip('/')}/{entry['file']}"
    yield from entry.get("urls", ())


def _answers(place: str) -> bool:
    if urlparse(place).scheme not in ("http", "https"):
        return Path(place).is_file()
    import requests  # takes a fifth of a second, which each job on a cluster would pay

    try:
        return requests.head(place, timeout=PROBE_SECONDS, allow_redirects=True).ok
    except requests.RequestException:
        return False
