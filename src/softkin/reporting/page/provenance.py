"""What was run: commit, versions, configuration, data, and what to cite."""

from __future__ import annotations

import platform
import re
import subprocess
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import requires
from pathlib import Path
from typing import Any

import yaml

from softkin import __version__
from softkin.core.distributions import installed
from softkin.core.narrowing import NARROWED
from softkin.data.own_files import in_words
from softkin.reporting.page.grid import Cell, Column, Grid, number_columns
from softkin.reporting.page.marks import Marks

#: Not part of what was run, and private: where this machine finds the data and keeps its runs.
LEFT_OUT = ("data_mirror", "tracking_uri", "sources")


def what_was_run(config: Mapping[str, Any], citation: Path, sources: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """The parts of the page that identify a run, by their names in the template; `citation` is CITATION.cff at the top
    of the checkout.
    """
    return {
        "campaign": config["campaign"],
        "caution": config.get("caution"),
        "seed": config["seed"],
        "written": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "commit": commit(citation.parent),
        "versions": versions(),
        "settings": settings(config),
        "citations": citations(citation, sources),
    }


def commit(checkout: Path) -> tuple[str, bool] | None:
    """(hash, whether files that git knows were changed since) of the checkout whose top folder this is; None if it is
    none, or git is not there.
    """
    top = _git(checkout, "rev-parse", "--show-toplevel")
    if top is None or Path(top).resolve() != checkout.resolve():
        return None
    head = _git(checkout, "rev-parse", "HEAD")
    return None if head is None else (head, bool(_git(checkout, "status", "--porcelain", "--untracked-files=no")))


def _git(folder: Path, *arguments: str) -> str | None:
    try:
        done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, check=True)
    except (FileNotFoundError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def versions() -> dict[str, str]:
    """softkin, Python and every library that softkin asks for, as installed where the report is written."""
    names = [re.split(r"[^\w.-]", line)[0] for line in requires("softkin") or [] if "extra ==" not in line]
    libraries = dict(installed(name) for name in sorted(names))
    return {"softkin": __version__, "Python": platform.python_version(), "System": platform.system(), **libraries}


def settings(config: Mapping[str, Any]) -> str:
    """The configuration of the run as YAML, fit to be saved and run again."""
    kept = {key: value for key, value in config.items() if key not in LEFT_OUT}
    return yaml.safe_dump(kept, sort_keys=False, default_flow_style=None, allow_unicode=True, width=100)


def citations(cff: Path, sources: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """What to cite: softkin and what it implements, from CITATION.cff, then the data, as an entry asks; once each."""
    content = yaml.safe_load(cff.read_text(encoding="utf-8"))
    works = [content, *(entry for entry in content.get("references", []) if entry["type"] != "data")]
    of_data = [entry["citation"].strip() for entry in sources.values() if "citation" in entry]
    return list(dict.fromkeys([*map(_citation, works), *of_data]))


def _citation(work: Mapping[str, Any]) -> str:
    authors = work["authors"]
    people = [person.get("name") or f"{person['family-names']}, {person['given-names']}" for person in authors]
    details = [str(work[key]) for key in ("version", "year", "doi", "url") if key in work]
    return ". ".join(["; ".join(people), work["title"], *details]) + "."


def _what_is_narrowed(dataset: str, entry: Mapping[str, Any]) -> str:
    """What a dataset is fitted with, where its entry narrows the configuration; empty where it does not."""
    own = "; ".join(f"{NARROWED[key]} {', '.join(entry[key])}" for key in NARROWED if key in entry)
    return f"Of what is configured, {dataset} gets by its entry alone: {own}." if own else ""


def data_grid(
    descriptions: Mapping[str, Mapping[str, Any]], sources: Mapping[str, Mapping[str, Any]], marks: Marks
) -> Grid:
    """One row per dataset: its sizes and the hash of its file."""
    rows = []
    for dataset, description in descriptions.items():
        sizes = [Cell(str(size)) for size in description["rows"].values()]
        constant = ", ".join(description["constant_coordinates"]) or "none"
        rows.append(
            [
                *(Cell(dataset, marks.of_dataset(dataset)), Cell(description["title"])),
                *(Cell(str(description["n_commands"])), Cell(str(description["n_markers"])), *sizes, Cell(constant)),
                *(Cell(in_words(sources[dataset])), Cell(description["sha256"], verdict="hash")),
            ]
        )
    sentence = (
        "What the models were fitted to: commands drive a robot, markers are the points on it whose positions are "
        f"predicted, in {marks.unit}. The hash identifies the content of the file."
    )
    sentence = " ".join([sentence, *(_what_is_narrowed(name, sources[name]) for name in descriptions)]).strip()
    columns = [Column("Robot"), Column("Title", is_wide=True), *number_columns("Commands", "Markers")]
    columns += number_columns("Train rows", "Validation", "Test", "Extrapolation")
    columns += [Column("Constant coordinates", is_wide=True), Column("File"), Column("SHA-256 of the file")]
    return Grid("data", "The data", sentence, columns, rows)
