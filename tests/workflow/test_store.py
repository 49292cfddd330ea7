"""The store of a complete run: made again from results/, and on a server."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
import pytest
from mlflow import MlflowClient

from softkin.core.files import sha256_of
from softkin.tracking.artifacts import folder_of
from softkin.tracking.records import KEY
from softkin.tracking.store import PARENT
from tests.conftest import HOUSE
from tests.workflow.conftest import House
from tests.workflow.mlflow_server import postgresql, serving, sqlite

pytestmark = pytest.mark.timeout(600)


def files_below(folder: Path, *, hashed: bool) -> dict[str, str]:
    """Path -> hash, or '' where the content names ids."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder).as_posix(): sha256_of([path]) if hashed else "" for path in files}


def local(uri: str | None) -> Path:
    assert uri is not None
    return folder_of(uri)


def experiment_id(client: MlflowClient, name: str) -> str:
    experiment = client.get_experiment_by_name(name)
    assert experiment is not None
    return str(experiment.experiment_id)


def content(work: Path) -> dict[str, Any]:
    """All that the store shows, apart from ids and times."""
    address = f"sqlite:///{work / 'mlflow.db'}"
    client = MlflowClient(address, address)
    shown: dict[str, Any] = {}
    experiments = client.search_experiments()
    everything = client.search_runs([one.experiment_id for one in experiments], max_results=1000)
    keys = {run.info.run_id: run.data.tags[KEY] for run in everything}
    for experiment in experiments:
        runs = client.search_runs([experiment.experiment_id], max_results=1000)
        shown[experiment.name] = experiment.tags
        for run in runs:
            ids = {name: keys.get(run.data.tags.get(name)) for name in (PARENT, "runs_of_its_dataset")}
            tags = run.data.tags | ids
            curves = {name for name in run.data.metrics if name.startswith("trials/")}
            shown[run.data.tags[KEY]] = {
                "name": (run.info.run_name, run.info.status),
                "params": run.data.params,
                "metrics": run.data.metrics,
                "curves": {
                    name: [(m.step, m.value) for m in client.get_metric_history(run.info.run_id, name)]
                    for name in curves
                },
                "tags": tags,
                "inputs": [(i.dataset.name, i.dataset.digest) for i in run.inputs.dataset_inputs] if run.inputs else [],
                "models": len(run.outputs.model_outputs) if run.outputs else 0,
                "artifacts": files_below(local(run.info.artifact_uri), hashed=True),
            }
    for registered in client.search_registered_models():
        versions = client.search_model_versions(f"name = '{registered.name}'")
        shown[registered.name] = (registered.description, registered.aliases)
        for version in versions:
            assert version.source is not None
            assert version.run_id is not None
            logged = client.get_logged_model(version.source.removeprefix("models:/"))
            shown[f"{registered.name}/{version.version}"] = {
                "description": version.description,
                "tags": version.tags,
                "run": client.get_run(version.run_id).data.tags[KEY],
                "model": (logged.name, str(logged.status), files_below(local(logged.artifact_location), hashed=False)),
            }
    return shown


def without_its_store(house: House, work: Path) -> House:
    """The run in another folder: its results, and what Snakemake knows of them."""
    for name in ("results", ".snakemake"):
        shutil.copytree(house.work / name, work / name)  # keeps the times of modification
    return House(house.root, work, house.mirror)


@pytest.mark.slow
def test_the_store_is_made_again_from_results_with_the_same_content(house: House, tmp_path: Path) -> None:
    recipe = re.search(r"^store:.*\n\t\$\(BIN\)/snakemake --cores \"\$\$CORES\" (.*)$",
                       (HOUSE / "Makefile").read_text(), re.MULTILINE)  # fmt: skip
    assert recipe is not None
    before = content(house.work)
    assert {"softkin-finger", "softkin-elastica_2023_09/1", "test/finger/champion"} <= set(before)
    assert "figures/ranking.png" in before["test/finger/gp/tuned"]["artifacts"]
    assert "model.joblib" in before["test/finger/lr/paper"]["artifacts"]
    lost = without_its_store(house, tmp_path / "work")
    done = lost.snakemake(*recipe[1].split())
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    after = content(lost.work)
    assert set(after) == set(before)
    assert {name: (before[name], after[name]) for name in before if after[name] != before[name]} == {}


@pytest.fixture(params=[sqlite, postgresql])
def server(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """URI of an MLflow server with a database behind it, that keeps the artifacts too."""
    with request.param(tmp_path) as database, serving(database, tmp_path) as running:
        yield running.uri


@pytest.mark.slow
def test_a_server_takes_the_place_of_the_file(house: House, server: str, tmp_path: Path) -> None:
    """One dataset's results, tracked to a server by an environment variable alone."""
    elsewhere = without_its_store(house, tmp_path / "work")
    work = elsewhere.work
    logged = []
    for options in ((), ("--forcerun", "track")):  # the second time nothing is logged anew
        done = elsewhere.snakemake(
            "results/finger/mlflow_runs.json", *options, more_environment={"MLFLOW_TRACKING_URI": server}
        )
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
        runs = MlflowClient(server).search_runs([experiment_id(MlflowClient(server), "finger")], max_results=1000)
        logged.append({run.info.run_id for run in runs})
    assert logged[0] == logged[1]
    assert not (work / "mlflow.db").exists()
    assert not (work / "mlartifacts").exists()
    client = MlflowClient(server, server)
    local_store = MlflowClient(f"sqlite:///{house.work / 'mlflow.db'}")
    local_runs = local_store.search_runs([experiment_id(local_store, "finger")], max_results=1000)
    assert {run.data.tags[KEY]: run.data.metrics for run in runs} == {
        run.data.tags[KEY]: run.data.metrics for run in local_runs
    }
    (best,) = [run for run in runs if run.data.tags[KEY] == "test/finger/gp/tuned"]
    assert {file.path for file in client.list_artifacts(best.info.run_id)} >= {"figures", "model.joblib", "fit.json"}
    picture = client.download_artifacts(best.info.run_id, "figures/ranking.png", str(tmp_path))
    assert Path(picture).read_bytes() == (work / "results" / "finger" / "figures" / "ranking.png").read_bytes()
    assert str(client.get_registered_model("softkin-finger").aliases["champion"]) == "1"
    code = (
        "import mlflow; model = mlflow.pyfunc.load_model('models:/softkin-finger@champion');"
        "model.predict(model.input_example).to_csv('predicted.csv', index=False)"
    )
    environment = os.environ | {"MLFLOW_TRACKING_URI": server}
    subprocess.run([sys.executable, "-c", code], env=environment, cwd=tmp_path, check=True, timeout=200)
    robot = joblib.load(work / "results" / "finger" / "calibrated_model.joblib")
    answer = pd.read_csv(tmp_path / "predicted.csv")
    commands = robot.train.commands[: len(answer)]
    np.testing.assert_allclose(answer.filter(like="y_pred"), robot.predict(commands), rtol=1e-12)
    bounds = robot.intervals(commands, [0.9])[0]
    np.testing.assert_allclose(answer.filter(regex="^upper"), bounds[..., 1], rtol=1e-12)
