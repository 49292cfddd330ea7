"""Result files -> MLflow. The only module that imports mlflow for logging; computing jobs never do.

Runs are found again by the tag `softkin.key`, and replaced only when `softkin.content`, a hash over what the run
shows (timings apart), has changed. So logging twice changes nothing.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
import sqlite3
import subprocess
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")

import pandas as pd
from filelock import FileLock
from mlflow import MlflowClient
from mlflow.entities import Dataset, DatasetInput, InputTag, Metric, Param, Run

from softkin import __version__
from softkin.files import read_json, sha256_of
from softkin.interface import SoftkinError

logger = logging.getLogger("softkin")

KEY, CONTENT, PARENT, NOTE = "softkin.key", "softkin.content", "mlflow.parentRunId", "mlflow.note.content"
SQLITE = "sqlite:///"


@dataclass(frozen=True, slots=True)
class Campaign:
    """One complete run of the workflow on one configuration: name, seed, where its store and artifacts are."""

    name: str
    seed: int
    tracking_uri: str
    artifacts: str


def create_store(tracking_uri: str) -> None:
    """Create the store if there is none. One job does this before any other opens it: first use is a race."""
    if tracking_uri.startswith(SQLITE):
        file = Path(tracking_uri.removeprefix(SQLITE)).resolve()
        with FileLock(f"{file}.lock"):
            MlflowClient(tracking_uri).search_experiments(max_results=1)
            connection = sqlite3.connect(file)
            connection.execute("PRAGMA journal_mode=WAL")
            connection.close()
    else:
        MlflowClient(tracking_uri).search_experiments(max_results=1)
    logger.info("the MLflow store is %s", tracking_uri)


def log_dataset(
    campaign: Campaign,
    *,
    description: str | Path,
    point: str | Path,
    runs: Mapping[tuple[str, str], Mapping[str, str]],
) -> dict[str, str]:
    """Log the runs of one dataset, each (model, preset) a child of the campaign's run; return key -> run id.

    `runs` gives for each (model, preset) its files: predictions, fit, and for a tuned model parameters and trials.

    Raises:
        SoftkinError: the store is gone.
    """
    _require_store(campaign.tracking_uri)
    client = MlflowClient(campaign.tracking_uri)
    about = read_json(description)
    scores = pd.read_csv(point)
    experiment = _experiment(client, about["dataset"], campaign.artifacts)
    parent = _campaign_run(client, experiment, campaign, about)
    logged = {"campaign": parent}
    for (model, preset), files in runs.items():
        mine = scores[(scores["model"] == model) & (scores["preset"] == preset)]
        logged[f"{model}/{preset}"] = _log_model_run(
            client, experiment, parent, campaign, about, model, preset, mine, files
        )
    stale = _runs(client, experiment, f"tags.`{PARENT}` = '{parent}'")
    for run in stale:
        if run.info.run_id not in logged.values():
            _delete(client, run)
    return logged


def _log_model_run(
    client: MlflowClient,
    experiment: str,
    parent: str,
    campaign: Campaign,
    about: Mapping[str, Any],
    model: str,
    preset: str,
    scores: pd.DataFrame,
    files: Mapping[str, str],
) -> str:
    fit = read_json(files["fit"])
    metrics = _metrics(scores)
    parameters = read_json(files["parameters"]) if "parameters" in files else {}
    content = _hash(
        {
            "metrics": {name: value for name, value in metrics.items() if not _is_timing(name)},
            "params": fit["params"],
            "predictions": sha256_of([files["predictions"]]),
            "fingerprint": parameters.get("fingerprint"),
            "n_trials": parameters.get("n_trials"),
        }
    )
    key = f"{campaign.name}/{about['dataset']}/{model}/{preset}"
    old = _runs(client, experiment, f"tags.`{KEY}` = '{key}'")
    current = [run for run in old if run.data.tags.get(CONTENT) == content and run.info.status == "FINISHED"]
    if current:
        for run in [run for run in old if run is not current[0]]:
            _delete(client, run)
        return str(current[0].info.run_id)

    outcome = scores.set_index("subset")["euclidean_mean_mm"]
    tags = {
        KEY: key,
        PARENT: parent,
        "campaign": campaign.name,
        "dataset": about["dataset"],
        "model": model,
        "preset": preset,
        "seed": str(campaign.seed),
        "data_sha256": about["sha256"],
        "git_commit": _git_commit(),
        "softkin_version": __version__,
        NOTE: f"**{about['title']}**, {model}, {preset} preset. Mean marker error: "
        f"{outcome['test']:.4g} mm on test, {outcome['extrapolation']:.4g} mm on extrapolation.",
    }
    run = client.create_run(experiment, run_name=f"{about['dataset']} · {model} · {preset}", tags=tags)
    run_id = str(run.info.run_id)
    now = int(time.time() * 1000)
    history = [Metric(name, value, now, 0) for name, value in metrics.items()]
    if "trials" in files:
        history += _trial_history(pd.read_csv(files["trials"]), now)
        history.append(Metric("cv_mae_mm", parameters["cv_mae_mm"], now, 0))
    params = [Param(name, str(value)) for name, value in fit["params"].items()]
    for start in range(0, len(history), 900):  # the store takes 1000 a batch
        client.log_batch(run_id, metrics=history[start : start + 900])
    client.log_batch(run_id, params=params)
    client.log_inputs(run_id, [_dataset_input(about)])
    for name in ("predictions", "trials", "parameters", "fit"):
        if name in files:
            client.log_artifact(run_id, files[name])
    # The content tag comes last: a run cut off before it is not taken for whole.
    client.set_tag(run_id, CONTENT, content)
    client.set_terminated(run_id)
    for run in old:
        _delete(client, run)
    return run_id


def _metrics(scores: pd.DataFrame) -> dict[str, float]:
    """test/rmse_mm, ...; fit_seconds and predict_us_per_row once."""
    timings = [name for name in scores.columns if _is_timing(name)]
    names = [name for name in scores.columns if name not in ("dataset", "subset", "model", "preset", *timings)]
    values = {f"{row['subset']}/{name}": float(row[name]) for _, row in scores.iterrows() for name in names}
    return values | {name: float(scores[name].iloc[0]) for name in timings}


def _is_timing(name: str) -> bool:
    return name in ("fit_seconds", "predict_us_per_row")


def _trial_history(trials: pd.DataFrame, now: int) -> list[Metric]:
    """The score of each complete trial, and the best so far, as curves over the trials."""
    scored = trials.dropna(subset=["cv_mae_mm"])
    pairs = (("trials/cv_mae_mm", scored["cv_mae_mm"]), ("trials/best_cv_mae_mm", scored["cv_mae_mm"].cummin()))
    return [
        Metric(name, float(value), now, int(step))
        for name, curve in pairs
        for step, value in zip(scored["trial"], curve, strict=True)
    ]


def _dataset_input(about: Mapping[str, Any]) -> DatasetInput:
    dataset = Dataset(
        name=about["dataset"],
        digest=about["sha256"][:36],
        source_type="file",
        source=json.dumps({"uri": about["dataset"], "sha256": about["sha256"]}),
        profile=json.dumps({"rows": about["rows"], "n_commands": about["n_commands"], "n_markers": about["n_markers"]}),
    )
    return DatasetInput(dataset, [InputTag("mlflow.data.context", "training and evaluation")])


def _experiment(client: MlflowClient, dataset: str, artifacts: str) -> str:
    found = client.get_experiment_by_name(dataset)
    if found is not None and found.lifecycle_stage == "deleted":
        client.restore_experiment(found.experiment_id)
    if found is not None:
        return str(found.experiment_id)
    location = (Path(artifacts) / dataset).resolve().as_uri()
    return str(client.create_experiment(dataset, artifact_location=location))


def _campaign_run(client: MlflowClient, experiment: str, campaign: Campaign, about: Mapping[str, Any]) -> str:
    key = f"{campaign.name}/{about['dataset']}"
    found = _runs(client, experiment, f"tags.`{KEY}` = '{key}'")
    if found:
        return str(found[0].info.run_id)
    tags = {
        KEY: key,
        "campaign": campaign.name,
        "dataset": about["dataset"],
        "data_sha256": about["sha256"],
        "seed": str(campaign.seed),
        NOTE: f"Campaign **{campaign.name}** on **{about['title']}**: one child run per model and preset.",
    }
    run = client.create_run(experiment, run_name=f"{about['dataset']} · {campaign.name}", tags=tags)
    client.set_terminated(run.info.run_id)
    return str(run.info.run_id)


def _runs(client: MlflowClient, experiment: str, query: str) -> list[Run]:
    return list(client.search_runs([experiment], query, max_results=1000))


def _delete(client: MlflowClient, run: Run) -> None:
    client.delete_run(run.info.run_id)


def _require_store(tracking_uri: str) -> None:
    if tracking_uri.startswith(SQLITE) and not Path(tracking_uri.removeprefix(SQLITE)).exists():
        raise SoftkinError(f"the MLflow store {tracking_uri} is gone; mend: `make store` makes it anew from results/")


def _git_commit() -> str:
    here = Path(__file__).parent
    answer = subprocess.run(["git", "rev-parse", "HEAD"], cwd=here, capture_output=True, text=True, check=False)
    return answer.stdout.strip() if answer.returncode == 0 else "not a git checkout"


def _hash(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()
