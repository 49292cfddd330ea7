"""A campaign on a real SLURM of one node, with an MLflow server on PostgreSQL: run by `make campaign-slurm`."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from mlflow import MlflowClient

from softkin.tracking.records import KEY
from tests.workflow.conftest import House
from tests.workflow.mlflow_server import postgresql, serving

pytestmark = [pytest.mark.slow, pytest.mark.timeout(7200)]
NODE = Path(__file__).with_name("one_node_slurm.sh")
#: What no two runs have in common.
TIMINGS = {"fit_seconds", "predict_us_per_row"}
#: The node has no accounting; the profile's 60 s are for network file systems.
OPTIONS = ["--profile", "profiles/slurm", "--slurm-status-command", "squeue", "--latency-wait", "20"]
OPTIONS += ["--slurm-init-seconds-before-status-checks", "5", "--retries", "0"]


@pytest.fixture
def node() -> Iterator[Path]:
    """A running SLURM; the folder of its files, which all may enter: munge takes no other, and pytest's are closed."""
    pytest.importorskip("snakemake_executor_plugin_slurm", reason="pip install softkin[slurm]")
    missing = [name for name in ("sinfo", "slurmctld", "slurmd", "munged") if not shutil.which(name)]
    if missing:
        pytest.skip(f"{', '.join(missing)} missing: apt-get install slurmctld slurmd slurm-client munge")
    if os.getuid() != 0:
        pytest.skip("only root can start a SLURM")
    with tempfile.TemporaryDirectory(prefix="slurm-") as name:
        folder = Path(name)
        subprocess.run(["bash", NODE, "up", folder], check=True, timeout=120)
        try:
            yield folder
        finally:
            subprocess.run(["bash", NODE, "down", folder], check=True, timeout=120)


def wait_for(what: Callable[[], object], run: subprocess.Popen[str], seconds: float = 3000) -> None:
    until = time.monotonic() + seconds
    while not what():
        assert run.poll() is None, "the run ended before"
        assert time.monotonic() < until, "it has not come"
        time.sleep(0.5)


def running_fits() -> list[str]:
    """SLURM's numbers of the fits that run now."""
    done = subprocess.run(["squeue", "-h", "-t", "R", "-o", "%i %k"], capture_output=True, text=True, check=True)
    return [line.split()[0] for line in done.stdout.splitlines() if "rule_fit_model" in line]


def metrics(uri: str) -> dict[str, dict[str, float]]:
    """Of each run in a store, by its key, what no clock has measured."""
    client = MlflowClient(uri)
    experiments = [experiment.experiment_id for experiment in client.search_experiments()]
    return {
        run.data.tags[KEY]: {name: value for name, value in run.data.metrics.items() if name not in TIMINGS}
        for run in client.search_runs(experiments, max_results=1000)
    }


def test_a_cluster_and_a_server_give_what_one_machine_gives(house: House, node: Path, tmp_path: Path) -> None:
    """A job is cancelled and the run repeated; the server goes away for a while as runs are logged to it."""
    with postgresql(tmp_path) as database, serving(database, tmp_path) as server:
        environment = house.environment() | {"MLFLOW_TRACKING_URI": server.uri}
        command = house.command(*OPTIONS, cores=None, work=tmp_path / "work")
        output = (tmp_path / "output.txt").open("w+")
        start: dict[str, Any] = {"env": environment, "cwd": house.root, "stdout": output, "stderr": output}
        with output, subprocess.Popen(command, **start) as run:
            wait_for(running_fits, run)
            subprocess.run(["scancel", running_fits()[0]], check=True)
            assert run.wait() != 0, "a job was cancelled"
        lost = [path for path in (house.work / "results").glob("*/*/*/model.joblib") if not twin(path, house, tmp_path)]
        assert len(lost) == 3  # the three presets of one model
        output = (tmp_path / "again.txt").open("w+")
        with output, subprocess.Popen(command, **start | {"stdout": output, "stderr": output}) as run:
            wait_for(lambda: metrics(server.uri), run)
            server.stop()
            time.sleep(5)
            server.start()
            assert run.wait() == 0, (tmp_path / "again.txt").read_text()[-5000:]
        assert metrics(server.uri) == metrics(f"sqlite:///{house.work / 'mlflow.db'}")
    assert_same_tables(house.work, tmp_path / "work")
    # Of each dataset: one job to prepare, one a model (4 and 1), one after that; and the one that was cancelled.
    assert len((node / "log" / "jobs.txt").read_text().splitlines()) == 2 * (1 + 5 + 1) + 1


def twin(path: Path, house: House, tmp_path: Path) -> bool:
    """Whether the other run has the file too."""
    return (tmp_path / "work" / path.relative_to(house.work)).exists()


def assert_same_tables(here: Path, there: Path) -> None:
    """Every table of one run as in the other, to the last digit, timings apart."""
    tables = sorted((here / "results" / "tables").glob("*.csv"))
    assert len(tables) > 10
    for path in tables:
        pair = [pd.read_csv(work / path.relative_to(here)) for work in (here, there)]
        one, other = (table.drop(columns=TIMINGS & set(table.columns)) for table in pair)
        pd.testing.assert_frame_equal(one, other, check_exact=True, obj=path.name)
