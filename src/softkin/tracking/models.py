"""Log the runs of a dataset: one per model and preset, children of the campaign's run."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from mlflow.entities import Dataset, DatasetInput, InputTag

from softkin import __version__
from softkin.core.csv_tables import read_csv
from softkin.core.escaping import markdown_text
from softkin.core.files import read_json, sha256_of
from softkin.core.runs import Run
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.core.units import own_unit, unit_of
from softkin.tracking.figure_index import content_of, shown_in
from softkin.tracking.records import CURRENT, YES, Record, find, put, retire, sweep, update
from softkin.tracking.saved_view import NAME, TAG, saved_view
from softkin.tracking.store import (
    NOTE,
    PARENT,
    Campaign,
    caution_content,
    caution_note,
    client_of,
    common_tags,
    experiment_of,
    read_description,
    unit_note,
)

TIMINGS = ("fit_seconds", "predict_us_per_row")
#: The files of a run that become artifacts.
ARTIFACTS = ("model", "predictions", "trials", "parameters", "fit")


@dataclass(frozen=True, slots=True)
class _ModelRun:
    """What is logged of a run: its rows of point_metrics.csv, its files by name, and the figures that show it."""

    run: Run
    scores: pd.DataFrame
    files: Mapping[str, str]
    figures: Sequence[Path]


def log_dataset(
    campaign: Campaign,
    *,
    description: str | Path,
    data_card: str | Path,
    point: str | Path,
    figures: str | Path,
    runs: Mapping[Run, Mapping[str, str]],
) -> dict[str, str]:
    """Log the runs of one dataset as children of the campaign's run; return 'campaign' and 'model/preset' -> run id.

    Parameters:
        campaign: the run of the workflow.
        description: dataset.json.
        data_card: data_card.json, which has the findings of the audit.
        point: point_metrics.csv.
        figures: folder of the dataset's figures, whose index.csv says which run each of them shows.
        runs: run -> its files: model, predictions, fit, and of a searched model parameters and trials.

    Raises:
        StoreError: the store is gone.
    """
    client = client_of(campaign.tracking_uri)
    described = read_description(description, data_card)
    scores = read_csv(point)
    experiment = experiment_of(client, described["dataset"])
    note = f"**{markdown_text(described['title'])}**, {described['origin']}. *Views*, at the top right, has *{NAME}*."
    note += unit_note(described) + _findings_note(described) + caution_note(campaign)
    for tag, value in {NOTE: note, "origin": described["origin"], TAG: saved_view()}.items():
        client.set_experiment_tag(experiment, tag, value)
    shown = shown_in(figures)
    sweep(client, experiment, campaign=campaign.name)
    parent = update(client, experiment, _campaign_record(campaign, described, shown.get(("", "", ""), [])))
    logged, keys = {"campaign": parent}, set()
    there = find(client, experiment, campaign=campaign.name, kind="model", **{CURRENT: YES})
    for place, (run, files) in enumerate(runs.items(), start=1):
        model, preset = run
        of_run = scores[(scores["model"] == model) & (scores["preset"] == preset)]
        model_run = _ModelRun(Run(model, preset), of_run, files, shown.get((model, preset, ""), []))
        record = _record(campaign, described, model_run, parent, place)
        logged[f"{model}/{preset}"] = put(client, experiment, record, there)
        keys.add(record.key)
    retire(client, there, keys)
    return logged


def _record(
    campaign: Campaign, description: Mapping[str, Any], model_run: _ModelRun, parent: str, place: int
) -> Record:
    """What MLflow shows of a run; `place` orders the runs, `parent` is the id of the campaign's run."""
    (model, preset), files = model_run.run, model_run.files
    fit = read_json(files["fit"])
    study = read_json(files["parameters"]) if "parameters" in files else {}
    metrics = _metrics(model_run.scores)
    errors = model_run.scores.set_index("subset")["euclidean_mean_mm"]
    note = f"**{markdown_text(description['title'])}**, {model}, {preset} preset. "
    unit = unit_of(description)
    note += f"Mean marker error: {errors[TEST]:.4g} {unit} on test, "
    note += (
        f"{errors[EXTRAPOLATION]:.4g} {unit} on extrapolation."
        + unit_note(description)
        + _findings_note(description)
        + caution_note(campaign)
    )
    return Record(
        key=f"{campaign.name}/{description['dataset']}/{model}/{preset}",
        name=f"{description['dataset']} · {model} · {preset}",
        content={
            "metrics": {name: value for name, value in metrics.items() if name not in TIMINGS},
            "params": fit["params"],
            "predictions": sha256_of([files["predictions"]]),
            "fingerprint": study.get("fingerprint"),
            "n_trials": study.get("n_trials"),
            "figures": content_of(model_run.figures),
            "findings": [finding["sentence"] for finding in description["findings"]],
            **own_unit(unit_of(description)),
            **caution_content(campaign),
        },
        tags={
            PARENT: parent,
            "kind": "model",
            **common_tags(campaign, description),
            "model": model,
            "preset": preset,
            "target_space": fit["target_space"],
            "git_commit": _git_commit(),
            "softkin_version": __version__,
            NOTE: note,
        },
        metrics=metrics | {name: study[name] for name in ("cv_mae_mm", "shell_mae_mm") if name in study},
        curves=_trial_curves(read_csv(files["trials"])) if "trials" in files else [],
        params={"target_space": fit["target_space"], **fit["params"]},
        inputs=[_dataset_input(description)],
        files=[files[name] for name in ARTIFACTS if name in files],
        figures=[str(path) for path in model_run.figures],
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


def _dataset_input(description: Mapping[str, Any]) -> DatasetInput:
    name, sha256 = description["dataset"], description["sha256"]
    dataset = Dataset(
        name=name,
        digest=sha256[:8],
        source_type="file",
        source=json.dumps({"uri": name, "sha256": sha256}),
        profile=json.dumps({key: description[key] for key in ("rows", "n_commands", "n_markers")}),
    )
    return DatasetInput(dataset, [InputTag("mlflow.data.context", "training and evaluation")])


def _campaign_record(campaign: Campaign, description: Mapping[str, Any], figures: Sequence[Path]) -> Record:
    title = markdown_text(description["title"])
    note = f"Campaign **{campaign.name}** on **{title}**: one child run per model and preset."
    tags = {
        "kind": "campaign",
        **common_tags(campaign, description),
        NOTE: note + _findings_note(description) + caution_note(campaign),
    }
    return Record(
        key=f"{campaign.name}/{description['dataset']}",
        name=f"{description['dataset']} · {campaign.name}",
        content={"tags": tags, "figures": content_of(figures)},
        tags=tags,
        inputs=[_dataset_input(description)],
        figures=[str(path) for path in figures],
        started=campaign.started,
    )


def _findings_note(description: Mapping[str, Any]) -> str:
    return "".join(
        f"\n\n**{finding['severity']}**: {markdown_text(finding['sentence'])}" for finding in description["findings"]
    )


def _git_commit() -> str:
    """The commit of the checkout that softkin runs from."""
    folder = Path(__file__).parent
    answer = subprocess.run(["git", "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, check=False)
    return answer.stdout.strip() if answer.returncode == 0 else "not a git checkout"
