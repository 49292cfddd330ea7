"""A folder of made-up results: `arm`, whose test rows leak, and `finger`, a stand-in with rows left out."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from softkin.core.clocks import Used
from softkin.core.files import write_json
from softkin.core.samples import SUBSETS
from softkin.reporting.page.build import RobotFiles, build_report
from softkin.reporting.page.jobs import Job
from tests.unit.reporting.page.frames import ROBOTS, TITLES, frames

NOTE = "Training error: copies of train rows."
FINDINGS = [
    {"severity": "leak", "subsets": ["test"], "sentence": "All rows stand in train.", "consequence": "So what."},
    {"severity": "note", "subsets": ["train"], "sentence": "A remark.", "consequence": "None."},
]


@dataclass(frozen=True)
class Results:
    """A folder of results, and the arguments of `build_report`."""

    folder: Path
    arguments: dict[str, Any]

    def build(self, name: str = "report.html", **changed: Any) -> Path:
        report = self.folder / name
        build_report(**self.arguments | {"report": report} | changed)
        return report


def draw(folder: Path) -> None:
    """Two pictures, one of them not in the index."""
    folder.mkdir(parents=True)
    noise = np.random.default_rng(0).integers(0, 255, (60, 90, 3), dtype=np.uint8)
    for name in ("intervals_paper", "an_extra_one"):
        Image.fromarray(noise).save(folder / f"{name}.png")
    index = {"figure": ["intervals_paper"] * 2, "title": ["Intervals around the paper's model"] * 2}
    index["caption"] = ["How to read it."] * 2
    pd.DataFrame(index).to_csv(folder / "index.csv", index=False)


def robot_files(folder: Path, dataset: str) -> RobotFiles:
    """Description, data card and figures of a robot."""
    title = f"{dataset.upper()} <made up>"
    description = {"dataset": dataset, "title": title, "sha256": "ab" * 32, "n_commands": 2, "n_markers": 1}
    description |= {"rows": dict.fromkeys(SUBSETS, 40), "constant_coordinates": []}
    description |= {"is_cut": True, "origin": "stand-in"} if dataset == "finger" else {"is_cut": False}
    findings = FINDINGS if dataset == "arm" else []
    card = {"title": title, "worst_severity": "leak" if findings else None, "findings": findings}
    files = RobotFiles(folder / "dataset.json", folder / "data_card.json", folder / "data_card.md", folder / "figures")
    draw(Path(files.figures))
    write_json(files.description, description)
    write_json(files.data_card, card | {"subsets": {subset: {"rows": 40} for subset in SUBSETS}})
    table = "| subset | rows <b> |\n| --- | --- |\n| test | 40 |\n"
    Path(files.card_page).write_text(f"# Card of {title}\n\n## The rows\n\n{table}")
    return files


def checkout(folder: Path) -> Path:
    """CITATION.cff at the top of a repository of one commit."""
    folder.mkdir()
    citation = folder / "CITATION.cff"
    citation.write_text("title: softkin\nversion: 1.0\nauthors: [{name: The authors}]\n")
    for command in (["init", "-q"], ["add", "."], ["-c", "user.name=me", "-c", "user.email=@", "commit", "-qm", "one"]):
        subprocess.run(["git", "-C", str(folder), *command], check=True)
    return citation


def timed_jobs(folder: Path) -> list[Job]:
    """A study and a job without records of its own."""
    benchmark, log, record = folder / "gp.tsv", folder / "gp.log", folder / "parameters.json"
    folder.mkdir()
    benchmark.write_text("s\tmax_rss\tcpu_time\n75.5\t200\t60\n")
    log.write_text(f"INFO {Used(60.0, 50.0, 200.0)}\n")
    write_json(record, {"n_trials": 30, "n_pruned": 4})
    return [Job("fit_model", "arm", "gp", benchmark, log, (record,)), Job("score", "arm", "", benchmark, log)]


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    folder = tmp_path_factory.mktemp("report") / "results"
    draw(folder / "tables" / "figures")
    tables = {folder / "tables" / f"{name}.csv": frame for name, frame in frames().items()}
    for path, frame in tables.items():
        frame.to_csv(path, index=False)
    sources: dict[str, Any] = {
        name: {"title": name.upper(), "file": f"{name}.json", "citation": "Someone (2023). Data."} for name in ROBOTS
    }
    sources["arm"]["notes"] = {"test": NOTE}
    bounds = {"models": ["gp"], "quantile_models": [], "max_fit_rows": {"gp": 40, "rf": 10}}
    private = {"tracking_uri": "postgresql://me:secret@host/db", "data_mirror": "/private/place"}
    arguments = {
        "tables": list(tables),
        "robots": {dataset: robot_files(folder / dataset, dataset) for dataset in ROBOTS},
        "campaign_figures": folder / "tables" / "figures",
        "jobs": timed_jobs(folder / "benchmarks"),
        "config": {"campaign": "made-up", "seed": 7, "datasets": [*ROBOTS], "sources": sources} | bounds | private,
        "titles": TITLES,
        "citation": checkout(folder.parent / "house"),
    }
    return Results(folder, arguments)


@pytest.fixture(scope="session")
def page(results: Results) -> Path:
    """The whole page of these results."""
    return results.build()
