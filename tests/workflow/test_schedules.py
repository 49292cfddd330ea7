"""The generated schedules start a real campaign with the real interpreter, from what cron and systemd give alone."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any

import pytest
import yaml
from mlflow import MlflowClient

from softkin.campaigns.schedules import FOLDER, Schedule, cron_line, systemd_service
from tests.conftest import HOUSE
from tests.unit.campaigns.test_schedules import read_as_cron, read_as_systemd
from tests.workflow.conftest import copy_house
from tests.workflow.test_campaign import SMALL

#: What cron and systemd set besides what the schedule sets.
GIVEN = {"LOGNAME": "me", "SHELL": "/bin/sh"}


@pytest.fixture
def schedule(tmp_path: Path) -> Schedule:
    """That of a folder of its own, with an environment that knows no other folder."""
    folder = tmp_path / "Haus 1"
    copy_house(folder)
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(folder / ".venv")], check=True)
    (packages,) = (folder / ".venv" / "lib").glob("python*/site-packages")
    (packages / "house.pth").write_text(f"{folder / 'src'}\n{sysconfig.get_path('purelib')}\n")
    rows = (HOUSE / "config" / "examples" / "bending_arm.csv").read_text().splitlines()[:301]
    (folder / "arm.csv").write_text("\n".join(rows) + "\n")
    entry: dict[str, Any] = {"title": "Arm", "format": "table_file", "file": "arm.csv", "position_unit": "mm"}
    entry |= {"commands": "p[0-9]_bar", "positions": ".*_[xyz]", "split": {"method": "random"}}
    plain = yaml.safe_load((folder / "config" / "config.yaml").read_text())
    small = plain | SMALL | {"ensembles": [], "tuning": plain["tuning"] | SMALL["tuning"]}
    (folder / "config" / "config.yaml").write_text(yaml.safe_dump(small))
    (folder / "config" / "datasets.yaml").write_text(yaml.safe_dump({"sources": {"arm": entry}}))
    (folder / FOLDER).mkdir(parents=True)
    (tmp_path / "home").mkdir()
    return Schedule(folder, folder / ".venv" / "bin" / "python", "03:17", notify="cat >> heard.txt")


def started(command: list[str], home: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Start a command from `/` with these variables and no others."""
    given = [f"{name}={value}" for name, value in {"HOME": str(home), **GIVEN, **environment}.items()]
    return subprocess.run(
        ["/usr/bin/env", "-i", *given, *command], cwd="/", capture_output=True, text=True, check=False, timeout=580
    )


def by_systemd(schedule: Schedule) -> tuple[list[str], dict[str, str]]:
    """The command of the service, and the variables that it sets besides HOME."""
    lines = systemd_service(schedule).splitlines()
    settings = [line.split("=", 1)[1] for line in lines if line.startswith("Environment=") and "HOME=" not in line]
    (line,) = (line for line in lines if line.startswith("ExecStart="))
    variables = dict(read_as_systemd(setting)[0].split("=", 1) for setting in settings)
    return read_as_systemd(line.split("=", 1)[1]), variables


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_a_night_by_cron_one_by_systemd_and_a_refit(schedule: Schedule, tmp_path: Path) -> None:
    home, results = tmp_path / "home", schedule.folder / "results"
    _, line = read_as_cron(cron_line(schedule))
    done = started(["/bin/sh", "-c", line], home, PATH="/usr/bin:/bin")
    log = (schedule.folder / FOLDER / "cron.log").read_text()
    assert done.returncode == 0, log[-3000:] + done.stderr
    assert done.stdout == done.stderr == ""
    assert json.loads((results / "verdict.json").read_text())["outcome"] == "first"

    command, variables = by_systemd(schedule)
    done = started(command, home, **variables)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    verdict = json.loads((results / "verdict.json").read_text())
    assert (verdict["outcome"], verdict["jobs_run"]) == ("unchanged", 0)
    n_jobs = verdict["jobs_reused"]

    done = started([*command, "--refit"], home, **variables)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    verdict = json.loads((results / "verdict.json").read_text())
    assert (verdict["outcome"], verdict["jobs_reused"], verdict["changes"]) == ("same", 0, [])
    assert verdict["jobs_run"] >= n_jobs
    assert all(one["now"] == pytest.approx(one["before"], rel=1e-9) for one in verdict["comparisons"])

    address = f"sqlite:///{schedule.folder / 'mlflow.db'}"
    client = MlflowClient(address, address)
    experiment = client.get_experiment_by_name("campaigns")
    assert experiment is not None
    runs = client.search_runs([experiment.experiment_id])
    assert [run.info.status for run in runs] == ["FINISHED"] * 3
    assert len(re.findall("^## The campaign", (schedule.folder / "heard.txt").read_text(), re.MULTILINE)) == 3
