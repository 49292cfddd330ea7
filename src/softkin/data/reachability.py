"""Which published datasets can be reached now, and the stand-ins that take the place of the others."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from softkin.core.credentials import with_credentials
from softkin.core.errors import RetrievalError

SUFFIX = "_standin"
#: Keys of an entry that are about the published data only.
PUBLISHED_ONLY = (
    "urls",
    "sha256",
    "licence",
    "citation",
    "paper_table",
    "paper_params",
    "notes",
    "clean",
    "relabel",
    "order",
    "session",
)


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
) -> dict[str, list[str]]:
    """Which `datasets` cannot be had now, and have a stand-in: what each of their sources answers.

    A dataset that was `retrieved` before (dataset -> file) can be had, and so can one without `standin` in its entry.
    """
    asked = [name for name in datasets if "standin" in sources[name] and not retrieved[name].exists()]
    if not asked:
        return {}
    from softkin.data.retrieve import why_out_of_reach  # takes a third of a second, which each job would pay

    def why(name: str) -> list[str]:
        urls = [with_credentials(url) for url in sources[name].get("urls", ())]
        return why_out_of_reach(file=sources[name]["file"], urls=urls, mirror=mirror)

    # Each waits for servers, not for the processor.
    with ThreadPoolExecutor(len(asked)) as pool:
        return {name: answers for name, answers in zip(asked, pool.map(why, asked), strict=True) if answers}


def with_stand_ins(
    datasets: Iterable[str], sources: Mapping[str, Mapping[str, Any]], replaced: Collection[str]
) -> tuple[list[str], dict[str, Any]]:
    """(datasets, sources): each dataset that is `replaced` has its stand-in there, under a name of its own."""
    entries = {name: dict(entry) for name, entry in sources.items()}
    entries |= {name + SUFFIX: stand_in_entry(sources[name]) for name in replaced}
    return [name + SUFFIX if name in replaced else name for name in datasets], entries


def warning(replaced: Mapping[str, Sequence[str]]) -> str:
    """The warning that stand-ins take the place of the datasets `replaced` (dataset -> what its sources answer), and
    how to get the published data.
    """
    reasons = [f"\n  {name}: {answer}" for name, answers in replaced.items() for answer in answers]
    error = RetrievalError(
        f"{', '.join(replaced)} cannot be reached. Robots simulated by softkin take their place, as <name>{SUFFIX}; "
        f"they are not the published data, and nothing is compared with the paper.{''.join(reasons)}",
        where="STAND-INS",
        fix="put the published files into a folder and name it in SOFTKIN_DATA_MIRROR, or run where their authors' "
        "repository can be reached; the next run uses them",
    )
    return str(error)
