"""A run per model and preset, children of the campaign's run."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from mlflow import MlflowClient
from mlflow.entities import Dataset, DatasetInput, InputTag

from softkin import __version__
from softkin.files import read_json, sha256_of
from softkin.findings import LEAK
from softkin.tracking.store import NOTE, PARENT, Campaign, Record, client_of, delete, experiment_of, find, put

TIMINGS = ("fit_seconds", "predict_us_per_row")


def log_dataset(
    campaign: Campaign,
    *,
    description: str | Path,
    data_card: str | Path,
    point: str | Path,
    runs: Mapping[tuple[str, str], Mapping[str, str]],
) -> dict[str, str]:
    """Log the runs of one dataset, each (model, preset) a child of the campaign's run; return key -> run id.

    `data_card` has the findings of the audit. `runs` gives for each (model, preset) its files: predictions, fit, and
    for a tuned model parameters and trials.

    Raises:
        SoftkinError: the store is gone.
    """
    client = client_of(campaign.tracking_uri)
    about = read_json(description)
    about["findings"] = read_json(data_card)["findings"]
    scores = pd.read_csv(point)
    experiment = experiment_of(client, about["dataset"], campaign.artifacts)
    logged = {"campaign": _campaign_run(client, experiment, campaign, about)}
    for (model, preset), files in runs.items():
        mine = scores[(scores["model"] == model) & (scores["preset"] == preset)]
        record = _record(campaign, about, model, preset, mine, files, parent=logged["campaign"])
        logged[f"{model}/{preset}"] = put(client, experiment, record)
    children = find(client, experiment, **{PARENT: logged["campaign"]})
    delete(client, [run for run in children if run.info.run_id not in logged.values()])
    return logged


def _record(
    campaign: Campaign,
    about: Mapping[str, Any],
    model: str,
    preset: str,
    scores: pd.DataFrame,
    files: Mapping[str, str],
    *,
    parent: str,
) -> Record:
    fit = read_json(files["fit"])
    tuned = read_json(files["parameters"]) if "parameters" in files else {}
    metrics = _metrics(scores)
    curves = _trial_curves(pd.read_csv(files["trials"])) if "trials" in files else []
    outcome = scores.set_index("subset")["euclidean_mean_mm"]
    return Record(
        key=f"{campaign.name}/{about['dataset']}/{model}/{preset}",
        name=f"{about['dataset']} · {model} · {preset}",
        content={
            "metrics": {name: value for name, value in metrics.items() if name not in TIMINGS},
            "params": fit["params"],
            "predictions": sha256_of([files["predictions"]]),
            "fingerprint": tuned.get("fingerprint"),
            "n_trials": tuned.get("n_trials"),
            "parent": parent,
            "findings": [finding["sentence"] for finding in about["findings"]],
        },
        tags={
            PARENT: parent,
            **_common_tags(campaign, about),
            "model": model,
            "preset": preset,
            "git_commit": _git_commit(),
            "softkin_version": __version__,
            NOTE: f"**{about['title']}**, {model}, {preset} preset. Mean marker error: "
            f"{outcome['test']:.4g} mm on test, {outcome['extrapolation']:.4g} mm on extrapolation."
            + "".join(f"\n\n**{found['severity']}**: {found['sentence']}" for found in about["findings"]),
        },
        metrics=metrics | ({"cv_mae_mm": tuned["cv_mae_mm"]} if tuned else {}),
        curves=curves,
        params=fit["params"],
        inputs=[_dataset_input(about)],
        files=[files[name] for name in ("predictions", "trials", "parameters", "fit") if name in files],
    )


def _common_tags(campaign: Campaign, about: Mapping[str, Any]) -> dict[str, str]:
    return {
        "campaign": campaign.name,
        "dataset": about["dataset"],
        "data_sha256": about["sha256"],
        "origin": about["origin"],
        "seed": str(campaign.seed),
        "leak": str(any(finding["severity"] == LEAK for finding in about["findings"])).lower(),
    }


def _metrics(scores: pd.DataFrame) -> dict[str, float]:
    """test/rmse_mm, ...; fit_seconds and predict_us_per_row once."""
    names = [name for name in scores.columns if name not in ("dataset", "subset", "model", "preset", *TIMINGS)]
    values = {f"{row['subset']}/{name}": float(row[name]) for _, row in scores.iterrows() for name in names}
    return values | {name: float(scores[name].iloc[0]) for name in TIMINGS}


def _trial_curves(trials: pd.DataFrame) -> list[tuple[str, int, float]]:
    """The score of each complete trial, and the best so far, over the trials."""
    scored = trials.dropna(subset=["cv_mae_mm"])
    pairs = (("trials/cv_mae_mm", scored["cv_mae_mm"]), ("trials/best_cv_mae_mm", scored["cv_mae_mm"].cummin()))
    return [
        (name, int(step), float(value))
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


def _campaign_run(client: MlflowClient, experiment: str, campaign: Campaign, about: Mapping[str, Any]) -> str:
    key = f"{campaign.name}/{about['dataset']}"
    note = f"Campaign **{campaign.name}** on **{about['title']}**: one child run per model and preset."
    record = Record(
        key=key,
        name=f"{about['dataset']} · {campaign.name}",
        content=key,
        tags={**_common_tags(campaign, about), NOTE: note},
    )
    return put(client, experiment, record)


def _git_commit() -> str:
    here = Path(__file__).parent
    answer = subprocess.run(["git", "rev-parse", "HEAD"], cwd=here, capture_output=True, text=True, check=False)
    return answer.stdout.strip() if answer.returncode == 0 else "not a git checkout"
