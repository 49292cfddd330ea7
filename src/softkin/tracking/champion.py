"""Register the calibrated model of a dataset in MLflow's registry, under the alias `candidate`.

The first one of a dataset is its champion at once. Later ones become it by the verdict of a campaign, see `promotion`.
The runs of all datasets' calibrated models are in one experiment, where they stand side by side.
"""

from __future__ import annotations

import hashlib
import json
import logging
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mlflow.pyfunc
import pandas as pd
from mlflow import MlflowClient
from mlflow.entities import LoggedModelOutput
from mlflow.entities.model_registry import ModelVersion
from mlflow.exceptions import MlflowException
from mlflow.models import Model, ModelSignature
from mlflow.types import ColSpec, ParamSchema, ParamSpec, Schema
from mlflow.utils.mlflow_tags import MLFLOW_MODEL_VERSIONS

import softkin
from softkin.core.csv_tables import read_csv
from softkin.core.distributions import installed
from softkin.core.files import file_sha256, sha256_of
from softkin.core.job_records import load_model
from softkin.core.runs import nearest_level
from softkin.core.samples import command_columns, coordinate_columns
from softkin.tracking import served_model
from softkin.tracking.model_card import model_card
from softkin.tracking.promotion import nominate
from softkin.tracking.records import CONTENT, Record, all_pages, put, sweep
from softkin.tracking.saved_view import CHAMPIONS_TAG, champions_view
from softkin.tracking.store import NOTE, Campaign, client_of, common_tags, experiment_of, read_description
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.intervals.spec import AUTO
from softkin.uncertainty.regions.spec import JOINT_INTERVALS

logger = logging.getLogger("softkin")

KIND = "champion"
#: The experiment that holds a run for the calibrated model of each dataset.
EXPERIMENT = "champions"
PARTS = ("y_pred", "lower", "upper", "joint_lower", "joint_upper")
#: The packages that a calibrated model needs where it is loaded; softkin's own code is logged with it.
REQUIREMENTS = ("mlflow", "numpy", "pandas", "scipy", "scikit-learn", "xgboost", "mapie", "crepes", "joblib", "pyarrow")
#: Rows of `train` in the input example.
EXAMPLES = 3


def log_champion(
    campaign: Campaign,
    *,
    description: str | Path,
    data_card: str | Path,
    point: str | Path,
    intervals: str | Path,
    calibrated_model: str | Path,
    parent: str,
) -> str:
    """Log the run of the calibrated model, register it, and give its version the alias `candidate`; return the version.

    The version that is there is kept while model and card are the same; versions of other content stay in the registry,
    without the alias.

    Parameters:
        campaign: the run of the workflow.
        description: dataset.json.
        data_card: data_card.json.
        point: point_metrics.csv.
        intervals: interval_metrics.csv.
        calibrated_model: the calibrated model (joblib).
        parent: id of the run that groups the runs of the dataset.
    """
    client = client_of(campaign.tracking_uri)
    described = read_description(description, data_card)
    model: CalibratedModel = load_model(calibrated_model)
    name = f"softkin-{described['dataset']}"
    key = {"model": model.spec.name, "preset": model.preset}
    scores = _rows(read_csv(point), **key)
    shown, level = _measured(read_csv(intervals), model)
    card = model_card(
        model, registered=name, description=described, scores=scores, intervals=shown, level=level,
        caution=campaign.caution,
    )  # fmt: skip
    record = Record(
        key=f"{campaign.name}/{described['dataset']}/{KIND}",
        name=f"{described['dataset']} · {model.spec.name} · {model.preset}",
        content={"model": sha256_of([calibrated_model]), "card": card},
        tags={
            **common_tags(campaign, described),
            "kind": KIND,
            "runs_of_its_dataset": parent,
            **key,
            "interval_method": model.method.name,
            NOTE: card,
        },
        metrics=_metrics(scores, shown, level),
        params={**key, "interval_method": model.method.name, "confidence_level": level},
        texts={"model_card.md": card},
        started=campaign.started,
    )
    experiment = _experiment(client)
    sweep(client, experiment, campaign=campaign.name, dataset=described["dataset"])
    run_id = put(client, experiment, record)
    return _version(client, name, run_id, record, Path(calibrated_model), model, level)


def _experiment(client: MlflowClient) -> str:
    """Id of the experiment of calibrated models, with its note and its view."""
    experiment = experiment_of(client, EXPERIMENT)
    client.set_experiment_tag(experiment, NOTE, "The calibrated models of all datasets, a current run of each.")
    client.set_experiment_tag(experiment, CHAMPIONS_TAG, champions_view())
    return experiment


def _rows(table: pd.DataFrame, **wanted: Any) -> pd.DataFrame:
    """The rows where columns have these values, by subset."""
    for column, value in wanted.items():
        table = table[table[column] == value]
    return table.set_index("subset")


def _measured(table: pd.DataFrame, model: CalibratedModel) -> tuple[pd.DataFrame, float]:
    """The scores of its intervals, and of its joint intervals, by subset; and the level that they are at."""
    level = nearest_level(sorted(table["confidence_level"].unique()))
    key = {"model": model.spec.name, "preset": model.preset, "confidence_level": level}
    # A model with shells gives the intervals of this method; in-domain they are those of its own.
    method = AUTO if model.shells else model.method.name
    shown = _rows(table, **key, interval_method=method, coordinate="mean_informative")
    joint = _rows(table, **key, interval_method=JOINT_INTERVALS)
    return shown.assign(joint_coverage=joint["coverage"], joint_size_mm=joint["size_mm"]), level


def _metrics(scores: pd.DataFrame, intervals: pd.DataFrame, level: float) -> dict[str, float]:
    """The metrics of the run, named as in the runs of models and of intervals."""
    values = {
        f"{subset}/{name}": float(value)
        for name in ("euclidean_mean_mm", "rmse_mm")
        for subset, value in scores[name].items()
    }
    of_intervals = ("coverage", "mean_width_mm", "winkler_mm", "winkler_without_gross_mm")
    for name in (*of_intervals, "joint_coverage", "joint_size_mm"):
        values |= {f"{subset}/{name}_{100 * level:g}": float(value) for subset, value in intervals[name].items()}
    return values


def _version(
    client: MlflowClient, name: str, run_id: str, record: Record, file: Path, model: CalibratedModel, level: float
) -> str:
    """The version with this content, registered where there is none; it is the candidate."""
    content = hashlib.sha256(json.dumps([record.key, record.content], sort_keys=True).encode()).hexdigest()
    versions = list(all_pages(client.search_model_versions, f"name = '{name}'"))
    _sweep_models(client, client.get_run(run_id).info.experiment_id, name, versions)
    same = [version for version in versions if version.tags.get(CONTENT) == content]
    if same:
        version = str(same[0].version)
    else:
        tags = {key: value for key, value in record.tags.items() if key not in (NOTE, "runs_of_its_dataset")}
        logged = _log_model(client, run_id, name, file, model, level, tags)
        try:
            client.create_registered_model(name, description=f"The calibrated forward kinematics of {model.dataset}.")
        except MlflowException as error:
            if error.error_code != "RESOURCE_ALREADY_EXISTS":
                raise
        made = client.create_model_version(
            name, f"models:/{logged}", run_id, tags | {CONTENT: content}, description=record.texts["model_card.md"],
            model_id=logged,
        )  # fmt: skip
        version = str(made.version)
        # The UI links the logged model to its version by this tag.
        client.set_logged_model_tags(logged, {MLFLOW_MODEL_VERSIONS: json.dumps([{"name": name, "version": version}])})
        logger.info("registered %s, version %s", name, version)
    nominate(client, name, version)
    return version


def _sweep_models(client: MlflowClient, experiment: str, name: str, versions: Sequence[ModelVersion]) -> None:
    """Delete the logged models of a name that no version has: a process was killed before it registered them."""
    used = {version.source for version in versions}
    for model in all_pages(client.search_logged_models, [experiment], f"name = '{name}'"):
        if f"models:/{model.model_id}" not in used:
            client.delete_logged_model(model.model_id)
            logger.info("removed a model from the store that had been cut off while it was logged")


def _log_model(
    client: MlflowClient, run_id: str, name: str, file: Path, model: CalibratedModel, level: float, tags: dict[str, Any]
) -> str:
    """Log the calibrated model with softkin's code and its requirements as an output of the run; return its id."""
    experiment = client.get_run(run_id).info.experiment_id
    logged = client.create_logged_model(experiment, name=name, source_run_id=run_id, tags=tags)
    commands = command_columns(model.train.commands.shape[1])
    with tempfile.TemporaryDirectory() as folder:
        mlflow.pyfunc.save_model(
            f"{folder}/model",
            python_model=served_model.__file__,
            artifacts={"calibrated_model": str(file.resolve())},
            model_config={"sha256": file_sha256(file)},
            code_paths=[str(Path(softkin.__file__).parent)],
            signature=_signature(model, level),
            input_example=pd.DataFrame(model.train.commands[:EXAMPLES], columns=commands),
            pip_requirements=["==".join(installed(package)) for package in REQUIREMENTS],
            mlflow_model=Model(
                artifact_path=logged.artifact_location,
                model_uuid=logged.model_id,
                model_id=logged.model_id,
                run_id=run_id,
            ),
        )
        client.log_model_artifacts(logged.model_id, f"{folder}/model")
    client.finalize_logged_model(logged.model_id, "READY")
    client.log_outputs(run_id, [LoggedModelOutput(logged.model_id, step=0)])
    return str(logged.model_id)


def _signature(model: CalibratedModel, level: float) -> ModelSignature:
    coordinates = coordinate_columns(model.train.positions.shape[1] // 3)
    outputs = [f"{part}_{name}" for part in PARTS for name in coordinates]
    outputs += ["failure_probability"] * (model.failures is not None)
    return ModelSignature(
        inputs=Schema([ColSpec("double", name) for name in command_columns(model.train.commands.shape[1])]),
        outputs=Schema([ColSpec("double", name) for name in outputs]),
        params=ParamSchema([ParamSpec("confidence_level", "double", level)]),
    )
