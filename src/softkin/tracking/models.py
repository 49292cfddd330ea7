"""A run per model and preset, children of the campaign's run."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
from mlflow.entities import Dataset, DatasetInput, InputTag

from softkin import __version__
from softkin.core.files import read_json, sha256_of
from softkin.core.runs import Run
from softkin.tracking.figure_index import content_of, shown_in
from softkin.tracking.saved_view import NAME, TAG, saved_view
from softkin.tracking.store import (
    NOTE,
    PARENT,
    Campaign,
    Record,
    client_of,
    common_tags,
    delete,
    experiment_of,
    find,
    put,
)

TIMINGS = ("fit_seconds", "predict_us_per_row")


def log_dataset(
    campaign: Campaign,
    *,
    description: str | Path,
    data_card: str | Path,
    point: str | Path,
    figures: str | Path,
    runs: Mapping[Run, Mapping[str, str]],
) -> dict[str, str]:
    """Log the runs of one dataset, each (model, preset) a child of the campaign's run; return key -> run id.

    `data_card` has the findings of the audit. `figures` is the folder of the dataset's figures, whose index.csv says
    which run each of them shows. `runs` gives for each (model, preset) its files: model, predictions, fit, and for a
    tuned model parameters and trials.

    Raises:
        SoftkinError: the store is gone.
    """
    client = client_of(campaign.tracking_uri)
    about = read_json(description)
    about["findings"] = read_json(data_card)["findings"]
    scores = pd.read_csv(point)
    experiment = experiment_of(client, about["dataset"], campaign.artifacts)
    note = f"**{about['title']}**, {about['origin']}. *Views*, at the top right, has *{NAME}*." + _findings_note(about)
    for tag, value in {NOTE: note, "origin": about["origin"], TAG: saved_view()}.items():
        client.set_experiment_tag(experiment, tag, value)
    shown = shown_in(figures)
    logged = {"campaign": put(client, experiment, _campaign_record(campaign, about, shown.get(("", "", ""), [])))}
    for place, ((model, preset), files) in enumerate(runs.items(), start=1):
        mine = scores[(scores["model"] == model) & (scores["preset"] == preset)]
        pictures = shown.get((model, preset, ""), [])
        record = _record(campaign, about, model, preset, mine, files, pictures, logged["campaign"], place)
        logged[f"{model}/{preset}"] = put(client, experiment, record)
    children = find(client, experiment, campaign=campaign.name, kind="model")
    delete(client, [run for run in children if run.info.run_id not in logged.values()])
    return logged


def _record(
    campaign: Campaign,
    about: Mapping[str, Any],
    model: str,
    preset: str,
    scores: pd.DataFrame,
    files: Mapping[str, str],
    figures: Sequence[Path],
    parent: str,
    place: int,
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
            "figures": content_of(figures),
            "findings": [finding["sentence"] for finding in about["findings"]],
        },
        tags={
            PARENT: parent,
            "kind": "model",
            **common_tags(campaign, about),
            "model": model,
            "preset": preset,
            "target_space": fit["target_space"],
            "git_commit": _git_commit(),
            "softkin_version": __version__,
            NOTE: f"**{about['title']}**, {model}, {preset} preset. Mean marker error: "
            f"{outcome['test']:.4g} mm on test, {outcome['extrapolation']:.4g} mm on extrapolation."
            + _findings_note(about),
        },
        metrics=metrics | {name: tuned[name] for name in ("cv_mae_mm", "shell_mae_mm") if name in tuned},
        curves=curves,
        params={"target_space": fit["target_space"], **fit["params"]},
        inputs=[_dataset_input(about)],
        files=[files[name] for name in ("model", "predictions", "trials", "parameters", "fit") if name in files],
        figures=[str(path) for path in figures],
        started=campaign.started - place,
        seconds=metrics["fit_seconds"],
    )


def _metrics(scores: pd.DataFrame) -> dict[str, float]:
    """test/rmse_mm, ...; fit_seconds and predict_us_per_row once."""
    names = [name for name in scores.columns if name not in ("dataset", "subset", "model", "preset", *TIMINGS)]
    values = {f"{row['subset']}/{name}": float(row[name]) for _, row in scores.iterrows() for name in names}
    return values | {name: float(scores[name].iloc[0]) for name in TIMINGS}


def _trial_curves(trials: pd.DataFrame) -> list[tuple[str, int, float]]:
    """The score of each complete trial, and the best so far, over the trials."""
    scored = trials.dropna(subset=["score_mm"])
    pairs = (("trials/score_mm", scored["score_mm"]), ("trials/best_score_mm", scored["score_mm"].cummin()))
    return [
        (name, int(step), float(value))
        for name, curve in pairs
        for step, value in zip(scored["trial"], curve, strict=True)
    ]


def _dataset_input(about: Mapping[str, Any]) -> DatasetInput:
    dataset = Dataset(
        name=about["dataset"],
        digest=about["sha256"][:8],
        source_type="file",
        source=json.dumps({"uri": about["dataset"], "sha256": about["sha256"]}),
        profile=json.dumps({"rows": about["rows"], "n_commands": about["n_commands"], "n_markers": about["n_markers"]}),
    )
    return DatasetInput(dataset, [InputTag("mlflow.data.context", "training and evaluation")])


def _campaign_record(campaign: Campaign, about: Mapping[str, Any], figures: Sequence[Path]) -> Record:
    tags = {
        "kind": "campaign",
        **common_tags(campaign, about),
        NOTE: f"Campaign **{campaign.name}** on **{about['title']}**: one child run per model and preset."
        + _findings_note(about),
    }
    return Record(
        key=f"{campaign.name}/{about['dataset']}",
        name=f"{about['dataset']} · {campaign.name}",
        content={"tags": tags, "figures": content_of(figures)},
        tags=tags,
        inputs=[_dataset_input(about)],
        figures=[str(path) for path in figures],
        started=campaign.started,
    )


def _findings_note(about: Mapping[str, Any]) -> str:
    return "".join(f"\n\n**{found['severity']}**: {found['sentence']}" for found in about["findings"])


def _git_commit() -> str:
    here = Path(__file__).parent
    answer = subprocess.run(["git", "rev-parse", "HEAD"], cwd=here, capture_output=True, text=True, check=False)
    return answer.stdout.strip() if answer.returncode == 0 else "not a git checkout"
