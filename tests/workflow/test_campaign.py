"""Campaigns on a finished run, and five nights in a row."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml
from mlflow import MlflowClient

from tests.conftest import HOUSE
from tests.workflow.conftest import House, copy_house

#: A robot, a model and few methods: a night takes a minute.
SMALL: dict[str, Any] = {
    "campaign": "nights",
    "datasets": ["arm"],
    "models": ["lr"],
    "presets": ["paper", "tuned"],
    "target_spaces": ["cartesian"],
    "interval_methods": ["scp_mapie", "scp_distance"],
    "regions": ["joint_box"],
    "regime": "in_domain",
    "tuning": {"n_trials": 2, "n_folds": 2, "max_rows": 80, "max_markers": 1},
}


def command(house: House, *configuration: Path, options: tuple[str, ...] = ()) -> list[str]:
    made = [sys.executable, "-m", "softkin.cli.campaign", "--snakefile", str(house.root / "Snakefile")]
    return [*made, "--directory", str(house.work), *options, "--configfile", *map(str, configuration)]


def campaign(house: House, *configuration: Path, options: tuple[str, ...] = ()) -> tuple[int, dict[str, Any]]:
    """Exit code and verdict of a campaign."""
    done = subprocess.run(
        command(house, *configuration, options=options),
        env=house.environment(), cwd=house.root, capture_output=True, text=True, check=False, timeout=580,
    )  # fmt: skip
    file = house.work / "results" / "verdict.json"
    assert file.exists(), done.stdout[-3000:] + done.stderr[-3000:]
    return done.returncode, json.loads(file.read_text())


def client_of(house: House) -> MlflowClient:
    """Of the store of a run, and of its registry."""
    address = f"sqlite:///{house.work / 'mlflow.db'}"
    return MlflowClient(address, address)


def nights(house: House) -> list[Any]:
    """The runs of campaigns, the first one first."""
    client = client_of(house)
    experiment = client.get_experiment_by_name("campaigns")
    assert experiment is not None
    return list(client.search_runs([experiment.experiment_id], order_by=["attributes.start_time ASC"]))


def aliases(house: House, name: str) -> Mapping[str, str]:
    client = client_of(house)
    return {alias: str(version) for alias, version in client.get_registered_model(name).aliases.items()}


@pytest.mark.timeout(600)
def test_a_finished_run_is_judged_and_an_unchanged_one_computes_nothing(house: House, tmp_path: Path) -> None:
    work = tmp_path / "work"
    shutil.copytree(house.work, work)
    here = House(house.root, work, house.mirror)
    configuration = (house.root / "config" / "test.yaml", house.mirror / "override.yaml")
    code, first = campaign(here, *configuration)
    assert (code, first["outcome"], first["jobs_run"]) == (0, "first", 0)
    code, second = campaign(here, *configuration)
    assert (code, second["outcome"], second["jobs_run"]) == (0, "unchanged", 0)
    assert {one["outcome"] for one in second["comparisons"]} == {"same"}
    one, other = nights(here)
    assert one.data.metrics["finger/test/rmse_mm"] == other.data.metrics["finger/test/rmse_mm"]
    assert other.data.tags["same_results_as"] == one.info.run_id
    assert (work / "mlartifacts" / "campaigns" / one.info.run_id / "artifacts" / "report.html").is_file()


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_five_nights_in_a_row(tmp_path: Path, mirror: Path) -> None:
    """Unchanged, new rows, a worse model on purpose, a change of code without effect, killed half-way."""
    copy_house(tmp_path / "house")
    (tmp_path / "work" / "data").mkdir(parents=True)
    house = House(tmp_path / "house", tmp_path / "work", mirror)
    file, lines = (
        house.work / "data" / "arm.csv",
        (HOUSE / "config" / "examples" / "bending_arm.csv").read_text().splitlines(),
    )
    file.write_text("\n".join(lines[:501]) + "\n")
    entry: dict[str, Any] = {"title": "Arm", "format": "table_file", "file": "data/arm.csv", "position_unit": "mm"}
    entry |= {"commands": "p[0-9]_bar", "positions": ".*_[xyz]", "split": {"method": "random"}}
    small = tmp_path / "small.yaml"
    small.write_text(yaml.safe_dump(SMALL | {"sources": {"arm": entry}}))
    plain = [sys.executable, "-m", "snakemake", "--cores", "2", "--snakefile", str(house.root / "Snakefile")]
    plain += ["--directory", str(house.work), "--configfile", str(small)]
    run = {"env": house.environment(), "cwd": house.root, "capture_output": True, "text": True, "timeout": 580}
    done = subprocess.run(plain, check=False, **run)  # type: ignore[call-overload]
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]

    code, verdict = campaign(house, small)
    assert (code, verdict["jobs_run"]) == (0, 0), verdict

    file.write_text("\n".join(lines) + "\n")
    code, verdict = campaign(house, small)
    assert code in (0, 4), verdict
    assert "arm has other rows" in " ".join(verdict["changes"])
    good = aliases(house, "softkin-arm")

    model = house.root / "src" / "softkin" / "models" / "linear.py"
    text = model.read_text()
    worse = text.replace("LinearRegression())", "Ridge(alpha=300.0))").replace(
        "import LinearRegression", "import Ridge"
    )
    assert worse != text
    model.write_text(worse)
    code, verdict = campaign(house, small)
    assert code == 3, verdict
    assert "arm, test: the mean error of a marker" in " ".join(verdict["reasons"])
    assert aliases(house, "softkin-arm") == {"champion": good["champion"], "candidate": str(int(good["candidate"]) + 1)}

    model.write_text(f"{worse}\n# A comment changes nothing.\n")
    code, verdict = campaign(house, small)
    assert (code, verdict["outcome"]) == (0, "same"), verdict
    assert verdict["jobs_run"] > 0
    assert any(sentence.startswith("code is ") for sentence in verdict["changes"])
    assert aliases(house, "softkin-arm")["champion"] == good["champion"], (
        "the gate lets through what the night before kept out"
    )

    model.write_text(f"{worse}\n# Another one.\n")
    with subprocess.Popen(command(house, small), env=house.environment(), cwd=house.root, start_new_session=True,
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as killed:  # fmt: skip
        log = house.work / "results" / "logs" / "fit_model" / "arm" / "lr.log"
        before, deadline = log.stat().st_mtime, time.monotonic() + 120
        while not log.exists() or log.stat().st_mtime == before:  # Snakemake removes it before the job starts
            assert time.monotonic() < deadline
            time.sleep(0.05)
        children = subprocess.run(["pgrep", "-P", str(killed.pid)], capture_output=True, text=True, check=True).stdout
        os.kill(killed.pid, signal.SIGKILL)
        os.kill(int(children.split()[0]), signal.SIGKILL)
    code, verdict = campaign(house, small)
    assert (code, verdict["outcome"]) == (0, "same"), verdict

    runs = nights(house)
    assert [run.data.tags["verdict"] for run in runs][2:] == ["worse", "same", "same"]
    assert len(runs) == 5
    assert all("arm/test/rmse_mm" in run.data.metrics for run in runs)
