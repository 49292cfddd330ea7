"""A whole run of config/demo.yaml: everything is there at its end, and says that its numbers are a demonstration's."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from mlflow import MlflowClient

from tests.conftest import HOUSE

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


def test_the_demonstration_runs_to_its_end(tmp_path: Path, mirror: Path) -> None:
    demo = HOUSE / "config" / "demo.yaml"
    command = [sys.executable, "-m", "snakemake", "--cores", "2", "--snakefile", str(HOUSE / "Snakefile")]
    command += ["--directory", str(tmp_path), "--configfile", str(demo), str(mirror / "override.yaml")]
    environment = os.environ | {
        "PYTHONPATH": str(HOUSE / "src"),
        "SOFTKIN_DATA_MIRROR": str(mirror),
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
    }
    environment.pop("MLFLOW_TRACKING_URI", None)
    done = subprocess.run(command, cwd=HOUSE, env=environment, capture_output=True, text=True, check=False, timeout=580)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    caution = yaml.safe_load(demo.read_text())["caution"]
    assert f"CAUTION: {caution}" in " ".join(done.stdout.split())
    assert caution in (tmp_path / "results" / "report.html").read_text()
    assert (tmp_path / "results" / "finger" / "calibrated_model.joblib").is_file()
    client = MlflowClient(f"sqlite:///{tmp_path / 'mlflow.db'}")
    runs = client.search_runs([experiment.experiment_id for experiment in client.search_experiments()])
    assert len(runs) > 10
    assert all(caution in run.data.tags["mlflow.note.content"] for run in runs)
