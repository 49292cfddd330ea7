"""Run the workflow on a folder of robots and print one table: do errors, intervals and promises hold on all of them?

    python -m benchmarks.robots FOLDER [--more config/few_trials.yaml] [--cores 2] [--keep PROJECT]

Each file in the folder is a robot, and each folder in it one in several files (parts of its rows, or trials), as
`make new-robot` takes them; where that asks, the first answer is taken, and said. A robot whose files are refused is in
the table with the first line of the message. Of the others it says, from their results: the mean error of a marker on
`test` and `extrapolation`, coverage and mean width of the deployed interval on `test`, what that promises, coverage in
extrapolation, and the codes of the audit's findings. The exit status is 1 where the run failed.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from benchmarks.measured_run import HOUSE, measured_run, snakemake
from softkin.cli.new_robot import main as new_robot
from softkin.core.csv_tables import read_csv
from softkin.core.files import read_json
from softkin.core.runs import nearest_level
from softkin.core.samples import EXTRAPOLATION, TEST

FEW_TRIALS = "config/few_trials.yaml"


def enter(folder: Path) -> dict[str, str]:
    """Write an entry for each robot of `folder` into config/datasets.yaml of the working directory: name -> what
    `new-robot` said against it, empty where it wrote one.
    """
    said = {}
    for robot in sorted(path for path in folder.iterdir() if not path.name.startswith(".")):
        files = sorted(map(str, robot.iterdir())) if robot.is_dir() else [str(robot)]
        name = re.sub(r"[^a-z0-9]+", "_", f"r_{robot.stem}".lower()).strip("_")
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as messages:
            status = new_robot(["--name", name, "--answer", "1", "--write", "--", *files])
        lines = messages.getvalue().splitlines()
        said[name] = next((line for line in lines if line.startswith("new_robot: ")), "refused") if status else ""
    return said


def row_of(name: str, results: Path) -> dict[str, Any]:
    """What the results say of a robot."""
    tables = results / "tables"
    choice, point, metrics = (
        of[of["dataset"] == name]
        for of in (
            read_csv(tables / f"{table}.csv") for table in ("interval_choice", "point_metrics", "interval_metrics")
        )
    )
    findings = read_json(results / name / "data_card.json")["findings"]
    deployed = choice[choice["deployed"]].iloc[0]
    is_run = (point["model"] == deployed["model"]) & (point["preset"] == deployed["preset"])
    errors = point[is_run].set_index("subset")["euclidean_mean_mm"]
    same = [metrics[key] == deployed[key] for key in ("model", "preset", "interval_method")]
    of_interval = metrics[same[0] & same[1] & same[2] & (metrics["subset"] == TEST)]
    level = nearest_level(sorted(of_interval["confidence_level"].unique()))
    return {
        "run": f"{deployed['model']} {deployed['preset']}",
        "test_mm": errors[TEST],
        "extrapolation_mm": errors[EXTRAPOLATION],
        "level": level,
        "coverage": deployed["test_coverage"],
        "width_mm": deployed["test_mean_width_mm"],
        "promise": of_interval.loc[of_interval["confidence_level"] == level, "guarantee"].iloc[0],
        "outer_coverage": deployed["extrapolation_coverage"],
        "findings": " ".join(dict.fromkeys(finding["code"] for finding in findings)),
    }


def table(said: dict[str, str], results: Path) -> pd.DataFrame:
    """A row for each robot; of one that was refused, what was said."""
    rows = [
        {"robot": name} | ({"findings": against} if against else row_of(name, results))
        for name, against in said.items()
    ]
    return pd.DataFrame(rows).set_index("robot")


def measure(folder: Path, project: Path, options: argparse.Namespace) -> int:
    """Enter all robots in a new `project`, run it, print the table; the exit status."""
    shutil.copytree(HOUSE / "config", project / "config")
    options.more = options.more.resolve()
    os.chdir(project)
    said = enter(folder)
    names = [name for name, against in said.items() if not against]
    if names:
        chosen = project / "robots.yaml"
        chosen.write_text(yaml.safe_dump({"campaign": "robots", "datasets": names}), encoding="utf-8")
        configurations = ["config/datasets.yaml", str(options.more), str(chosen)]
        run = measured_run(
            snakemake(project, "--cores", str(options.cores), "--quiet", "rules", "--configfile", *configurations),
            folder=project,
        )
        print(f"{len(names)} robots: {run.wall:.0f} s, {run.cpu:.0f} s of CPU, {run.gigabytes:.2f} GB at most")
        if run.status:
            return 1
    print(table(said, project / "results").round(4).to_string(na_rep=""))
    return 0


def main() -> int:
    """Run; the exit status is 1 where the workflow failed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path, help="files and folders, a robot each")
    parser.add_argument("--more", type=Path, default=HOUSE / FEW_TRIALS, help="a file that overrides the configuration")
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--keep", type=Path, help="work in this new folder and leave it")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        project = (options.keep or Path(temporary) / "project").resolve()
        project.mkdir(parents=True)
        return measure(options.folder.resolve(), project, options)


if __name__ == "__main__":
    sys.exit(main())
