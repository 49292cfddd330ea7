"""Runs that are killed at random moments: the next plain run finishes, and nothing tells it from an undisturbed one.

SOFTKIN_KILLS: how many, 20 by default; SOFTKIN_KILLS_SEED: of the moments, 0 by default.
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import psutil
import pytest
import yaml
from mlflow import MlflowClient
from mlflow.entities import ViewType

from softkin.tracking.artifacts import folder_of
from softkin.tracking.records import CURRENT, KEY
from tests.conftest import HOUSE
from tests.workflow.conftest import House, copy_house, processes
from tests.workflow.test_campaign import SMALL

#: A store of another name than MLflow's own, in folders of names that are hard to quote.
STORE, WORK = "Läufe 1.db", "Arbeit für 🦾 {}"
N_KILLS = int(os.environ.get("SOFTKIN_KILLS", "20"))
#: Of a run from nothing these are others each time.
TIMINGS = ["fit_seconds", "predict_us_per_row", "seconds", "cpu_seconds"]
#: What is killed. A terminal that is closed sends SIGHUP to all.
VICTIMS = ("snakemake", "job", "both", "terminal")
#: When: somewhere in a run from nothing, or within seconds of the start of a job that nothing else waits for.
TRACKING, RETRIEVAL, SOMEWHERE = "tracking", "retrieval", "somewhere"
MOMENTS = (TRACKING, SOMEWHERE, RETRIEVAL, SOMEWHERE, SOMEWHERE)
#: What is deleted of a finished run so that its next job is the one that is killed.
DELETED = {
    TRACKING: [f"{STORE}*", "mlartifacts", "results/mlflow_store.json", "results/arm/mlflow_runs.json"],
    RETRIEVAL: ["results/arm/raw"],
}
LOG = {TRACKING: "results/logs/track/arm.log", RETRIEVAL: "results/logs/retrieve/arm.log"}
SECONDS = {TRACKING: 8.0, RETRIEVAL: 0.5}


@dataclass(frozen=True)
class Calm:
    """An undisturbed run, and the configuration that it had."""

    house: House
    small: Path

    def command(self, work: Path) -> list[str]:
        command = [sys.executable, "-m", "snakemake", "--cores", "2", "--snakefile", str(self.house.root / "Snakefile")]
        return [*command, "--directory", str(work), "--configfile", str(self.small)]

    def run(self, work: Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            self.command(work), env=self.house.environment(), cwd=self.house.root,
            capture_output=True, text=True, check=False, timeout=900,
        )  # fmt: skip


@pytest.fixture(scope="module")
def calm(tmp_path_factory: pytest.TempPathFactory, mirror: Path) -> Calm:
    folder = tmp_path_factory.mktemp("kills")
    copy_house(folder / "house")
    house = House(folder / "house", folder / WORK.format(0), mirror)
    entry: dict[str, Any] = {"title": "Arm", "format": "table_file", "position_unit": "mm"}
    entry |= {"file": str(folder / "arm.csv"), "commands": "p[0-9]_bar", "positions": ".*_[xyz]"}
    lines = (HOUSE / "config" / "examples" / "bending_arm.csv").read_text().splitlines()
    (folder / "arm.csv").write_text("\n".join(lines[:501]) + "\n")
    small = folder / "small.yaml"
    sources = {"arm": entry | {"split": {"method": "random"}}}
    small.write_text(yaml.safe_dump(SMALL | {"tracking_uri": f"sqlite:///{STORE}", "sources": sources}))
    house.work.mkdir()
    calm = Calm(house, small)
    done = calm.run(house.work)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return calm


@pytest.mark.slow
@pytest.mark.timeout(4 * 3600)
def test_a_run_that_was_killed_ends_as_an_undisturbed_one(calm: Calm, tmp_path: Path) -> None:
    chance = random.Random(int(os.environ.get("SOFTKIN_KILLS_SEED", "0")))
    undisturbed, killed = store(calm.house.work), Counter[tuple[str, str]]()
    for number in range(N_KILLS):
        moment, victim = MOMENTS[number % len(MOMENTS)], VICTIMS[number % len(VICTIMS)]
        work, at = tmp_path / WORK.format(number), ""
        for _ in range(5):  # until the run has not ended before
            shutil.rmtree(work, ignore_errors=True)
            prepare(calm, work, moment)
            at = interrupt(calm, work, moment, victim, chance)
            if at:
                break
        assert at, f"kill {number}: the run had ended each time"
        left = {path.name for path in parts(work)}, len(list(processes(work)))
        started = time.monotonic()
        done = calm.run(work)
        said = f"kill {number}: {victim} {at}, {left[1]} processes and {len(left[0])} half files left"
        print(f"{said}; the next run took {time.monotonic() - started:.0f} s", flush=True)
        assert done.returncode == 0, said + done.stdout[-3000:] + done.stderr[-3000:]
        assert_same_tables(calm.house.work, work)
        assert store(work) == undisturbed, said
        assert list(processes(work)) == [], said
        assert parts(work) == [], said
        killed[moment, victim] += 1
        shutil.rmtree(work)
    assert sum(killed.values()) == N_KILLS


def prepare(calm: Calm, work: Path, moment: str) -> None:
    """A folder in which the next run starts with what is killed."""
    if moment == SOMEWHERE:
        work.mkdir()
        return
    shutil.copytree(calm.house.work, work)
    for pattern in DELETED[moment]:
        for path in work.glob(pattern):
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    (work / LOG[moment]).unlink()


def logs(work: Path) -> list[Path]:
    """The logs of jobs that have begun."""
    return list((work / "results" / "logs").rglob("*.log"))


def interrupt(calm: Calm, work: Path, moment: str, victim: str, chance: random.Random) -> str:
    """Start a run and kill what is to be killed; say when that was, or nothing where the run had ended before.

    Somewhere in a run is when so many of its jobs have begun: seconds are others on a machine that others use, too.
    """
    with subprocess.Popen(
        calm.command(work), env=calm.house.environment(), cwd=calm.house.root,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
    ) as run:  # fmt: skip
        if moment == SOMEWHERE:
            begun = chance.randint(1, len(logs(calm.house.work)))
            wait_for(lambda: len(logs(work)) >= begun or run.poll() is not None, run, must_run=False)
            seconds, what = chance.uniform(0.0, 4.0), f"job {begun} of a run from nothing"
        else:
            wait_for(lambda: (work / LOG[moment]).exists(), run)
            seconds, what = chance.uniform(0.0, SECONDS[moment]), moment
        with suppress(subprocess.TimeoutExpired):
            run.wait(seconds)
        hit = run.poll() is None and kill(run, work, victim)
        run.wait()
    return f"{seconds:.1f} s after the start of {what}" if hit else ""


def kill(run: subprocess.Popen[bytes], work: Path, victim: str) -> bool:
    """Kill by a signal that no process can hear, or as a closed terminal does; whether there was what to kill."""
    if victim == "both":
        os.killpg(run.pid, signal.SIGKILL)
    elif victim == "terminal":
        os.killpg(run.pid, signal.SIGHUP)
    elif victim == "snakemake":
        os.kill(run.pid, signal.SIGKILL)
    else:
        wait_for(lambda: jobs(work) or run.poll() is not None, run, must_run=False)
        try:
            jobs(work)[0].kill()
        except (IndexError, psutil.NoSuchProcess):
            return False
    return True


def wait_for(what: Any, run: subprocess.Popen[bytes], *, must_run: bool = True) -> None:
    until = time.monotonic() + 1800
    while not what():
        assert time.monotonic() < until
        assert not must_run or run.poll() is None, "the run ended before"
        time.sleep(0.02)


def jobs(work: Path) -> list[psutil.Process]:
    """Those of them that run a script."""
    found = []
    for process in processes(work):
        with suppress(psutil.NoSuchProcess, psutil.AccessDenied):
            if any(".snakemake/scripts/" in word for word in process.cmdline()):
                found.append(process)
    return found


def parts(work: Path) -> list[Path]:
    return [path for path in work.rglob("*.part") if path.is_file()]


def assert_same_tables(here: Path, there: Path) -> None:
    """Every table of one run as in the other, to the last digit, timings apart."""
    tables = {path.relative_to(here) for path in (here / "results").rglob("*.csv") if ".snakemake" not in path.parts}
    tables = {path for path in tables if "logs" not in path.parts}
    assert {path.relative_to(there) for path in (there / "results").rglob("*.csv")} >= tables
    assert len(tables) > 10
    for path in sorted(tables):
        one, other = (pd.read_csv(folder / path).drop(columns=TIMINGS, errors="ignore") for folder in (here, there))
        pd.testing.assert_frame_equal(one, other, check_exact=True, obj=str(path))


def store(work: Path) -> dict[str, Any]:
    """What a store has of each key: no run twice, none that still runs, no logged model that is half there."""
    client = MlflowClient(f"sqlite:///{work / STORE}")
    found: dict[str, Any] = {}
    assert {path.name for path in work.rglob("*.db")} == {STORE}, "another store was made"
    for experiment in client.search_experiments(view_type=ViewType.ACTIVE_ONLY):
        runs = client.search_runs([experiment.experiment_id], max_results=1000)
        assert {run.info.status for run in runs} <= {"FINISHED"}
        current = Counter(run.data.tags[KEY] for run in runs if run.data.tags[CURRENT] == "true")
        assert not [key for key, number in current.items() if number > 1]
        models = client.search_logged_models([experiment.experiment_id])
        assert {str(model.status) for model in models} <= {"READY", "LoggedModelStatus.READY"}
        assert all(folder_of(str(model.artifact_location)).exists() for model in models)
        found[experiment.name] = (sorted(current), len(runs), len(models))
    for registered in client.search_registered_models():
        versions = client.search_model_versions(f"name = '{registered.name}'")
        found[registered.name] = (len(versions), dict(registered.aliases))
    return found
