"""Entries of config/datasets.yaml, checked for what a schema cannot say, before anything runs."""

from __future__ import annotations

import math
import os
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

from softkin.core.addresses import problems_of_url
from softkin.core.units import reason_against
from softkin.data import own_files
from softkin.data.reachability import SUFFIX
from softkin.data.readers.columns import MAX_COMMANDS

#: Folders of results/ that are no dataset's; and beside them that of `make demo`, which has results of its own.
OWN_FOLDERS = ("tables", "logs", "benchmarks", "studies", "studies_before_refit", "manifest", "schedules", "peers")
RESERVED = (*OWN_FOLDERS, "demo")
#: Experiments of MLflow that are no dataset's, each of which has one of its name.
EXPERIMENTS = ("campaigns", "champions", "history")
#: The format of a stand-in's file, which has no entry.
SIMULATED = "simulated"
#: mm: farther from the origin no base of a robot stands; a shorter axis has no direction.
FARTHEST_MM, SHORTEST_AXIS = 1e7, 1e-9


def problems_of_entries(config: Mapping[str, Any]) -> list[str]:
    """A line for each entry that cannot be used, and for each configured dataset whose own file is not there."""
    sources, chosen = config["sources"], config["datasets"]
    problems = [problem for name, entry in sources.items() for problem in _problems(name, entry, sources)]
    titles = Counter(sources[name]["title"].strip() for name in chosen)
    for title, count in titles.items():
        if count > 1:
            names = ", ".join(name for name in chosen if sources[name]["title"].strip() == title)
            problems.append(f"sources: the datasets {names} have one title, '{title}'; give each its own")
    own = {name: sources[name] for name in chosen if "urls" not in sources[name]}
    return [*problems, *(problem for name, entry in own.items() for problem in _problems_of_files(name, entry))]


def reason_against_name(name: str) -> str:
    """Why no dataset may have this name, which is softkin's own; empty where one may."""
    if name in RESERVED:
        return f"results/{name} is a folder of softkin's own"
    return f"{name} is an experiment of softkin's own in MLflow" if name in EXPERIMENTS else ""


def _problems(name: str, entry: Mapping[str, Any], sources: Mapping[str, Any]) -> Iterator[str]:
    key = f"sources.{name}"
    if reason := reason_against_name(name):
        yield f"{key}: {reason}; choose another name"
    if name.endswith(SUFFIX) and name.removesuffix(SUFFIX) in sources:
        yield f"{key}: that is the name of the stand-in of {name.removesuffix(SUFFIX)}; choose another name"
    if not entry["title"].strip() or "\n" in entry["title"].strip():
        yield f"{key}.title: empty, or of several lines; write what tables are to call it"
    if entry["format"] == SIMULATED:
        yield f"{key}.format: '{SIMULATED}' is for stand-ins, which softkin makes itself; write another"
    if reason := reason_against(entry["position_unit"]):
        yield f"{key}.position_unit: {reason}"
    if "urls" in entry:
        yield from _problems_of_published(key, entry)
    for field in ("commands", "positions"):
        if isinstance(entry.get(field), str) and (reason := _reason_against_pattern(entry[field])):
            yield f"{key}.{field}: '{entry[field]}' is no pattern: {reason}; write a list of columns"
    if "split" in entry:
        yield from _problems_of_columns(key, entry)
    if "names" in entry.get("split", {}):
        counts = Counter(str(called) for called in entry["split"]["names"].values())
        yield from (
            f"{key}.split.names: '{called}' names {count} subsets" for called, count in counts.items() if count > 1
        )
    yield from _problems_of_base(f"{key}.base", entry.get("base", {}))


def _problems_of_published(key: str, entry: Mapping[str, Any]) -> Iterator[str]:
    for number, url in enumerate(entry["urls"]):
        yield from problems_of_url(url, f"{key}.urls.{number}")
    path = entry["file"]
    if PurePosixPath(path).is_absolute() or PureWindowsPath(path).drive or ".." in re.split(r"[/\\]", path):
        yield f"{key}.file: '{path}' leads out of the mirror; write the file's name in it"


def _reason_against_pattern(pattern: str) -> str:
    try:
        re.compile(pattern)
    except re.error as error:
        return str(error)
    return ""


def _problems_of_columns(key: str, entry: Mapping[str, Any]) -> Iterator[str]:
    """What can be told of lists of columns without the file."""
    commands, positions = entry["commands"], entry["positions"]
    for field, number, per in (("commands", "n_commands", 1), ("positions", "n_markers", entry.get("dimensions", 3))):
        if isinstance(entry[field], str):
            continue
        count = len(entry[field])
        if count % per:
            yield f"{key}.{field}: {count} columns, but {per} per marker; name all, or write dimensions: {5 - per}"
        elif entry.get(number, count // per) != count // per:
            yield f"{key}.{number}: {entry[number]}, but `{field}` names {count // per}"
    for field, named in (("commands", commands), ("positions", positions)):
        twice = (
            [] if isinstance(named, str) else sorted(set(named) & set(entry.get("orientation", {}).get("columns", ())))
        )
        if twice:
            yield f"{key}: '{twice[0]}' stands in `{field}` and in `orientation`; name each column once"
    if isinstance(commands, Sequence) and not isinstance(commands, str) and not isinstance(positions, str):
        twice = sorted(set(commands) & set(positions))
        if twice:
            yield f"{key}: '{twice[0]}' stands in `commands` and in `positions`; name each column once"
        if len(commands) > MAX_COMMANDS:
            yield f"{key}.commands: {len(commands)} columns, of at most {MAX_COMMANDS}"


def _problems_of_base(key: str, base: Mapping[str, Any]) -> Iterator[str]:
    for place, value in enumerate(base.get("origin", ())):
        if value is not None and abs(value) > FARTHEST_MM:
            yield f"{key}.origin.{place}: {value:g} mm is farther than any robot stands; write mm"
    axis = base.get("axis")
    if axis is not None and not SHORTEST_AXIS < math.hypot(*axis) < 1 / SHORTEST_AXIS:
        yield f"{key}.axis: {list(axis)} is no direction; write one such as [0, 0, 1]"


def _problems_of_files(name: str, entry: Mapping[str, Any]) -> Iterator[str]:
    """What is wrong with the files of one's own that an entry names."""
    if "files" not in entry:
        if reason := _reason_against_file(entry["file"]):
            yield f"sources.{name}.file: {reason}"
        return
    for place, item in enumerate(own_files.named(entry)):
        found = own_files.matching(item)
        if not found:
            yield f"sources.{name}.files.{place}: no file is named like '{item}'; correct the pattern or the path"
        if reason := next((reason for file in found if (reason := _reason_against_file(file))), ""):
            yield f"sources.{name}.files.{place}: {reason}"
    columns = entry.get("join", {}).get("column")
    if isinstance(columns, list) and len(columns) != len(entry["files"]):
        yield f"sources.{name}.join.column: {len(columns)} columns for {len(entry['files'])} files; name one for each"
    if "join" in entry and len(entry["files"]) < 2:
        yield f"sources.{name}.join: one item of `files` cannot be joined; name the other, or leave `join` out"


def _reason_against_file(file: str) -> str:
    """Why a file of one's own cannot be read; empty where it can."""
    path = Path(file)
    try:
        if path.is_dir():
            return f"{file} is a folder; name the file in it"
        if not path.exists():
            return f"there is no file {file}; correct the path, which starts in the working directory of the run"
        return "" if os.access(path, os.R_OK) else f"{file} may not be read; change its permissions"
    except (OSError, ValueError) as error:
        return f"'{file[:60]}' is no path: {error}"
