"""Tables, headline, page, model card, calibrated model, MLflow and summary say alike what is chosen and deployed."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from unittest.mock import Mock

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.campaigns.summary import Layout, summarise
from softkin.core.bounds import bounds_frame
from softkin.core.files import read_json, write_json
from softkin.core.job_records import record_job
from softkin.core.run_archive import RunArchive
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, TRAIN
from softkin.data.table import to_table, write_table
from softkin.evaluation.score_intervals import score_intervals
from softkin.models import MODELS
from softkin.reporting.page.choices import read_choices
from softkin.reporting.page.headline import robot_cards
from softkin.reporting.page.marks import Marks
from softkin.reporting.page.scores import choice_grid, interval_grid
from softkin.reporting.page.singles import Singles
from softkin.reporting.tables.headline import headline
from softkin.reporting.tables.interval_choice import chosen_intervals, deployed_intervals, interval_choice
from softkin.reporting.tables.interval_layout import interval_table
from softkin.reporting.titles import Titles
from softkin.tracking import champion
from softkin.tracking.store import Campaign
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.predict import predict
from softkin.uncertainty.build_calibrated_model import build_calibrated_model
from softkin.uncertainty.calibrate import calibrate
from softkin.uncertainty.choose import choose, deployed_choice
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.stored_outputs import StoredOutputs
from tests.conftest import four_subsets

RIDGE, GB = Run("ridge", "tuned"), Run("gb", "tuned")
METHODS = {name: INTERVAL_METHODS[name] for name in ("scp_mapie", "scp_distance", "cqr", "auto")}
#: Methods are called by their names: their titles have commas.
TITLES = Titles({name: spec.title for name, spec in MODELS.items()}, {name: name for name in METHODS})
DESCRIPTION: dict[str, Any] = {"dataset": "arm", "title": "ARM", "origin": "own", "sha256": "ab", "n_commands": 2}
DESCRIPTION |= {"n_markers": 1, "is_cut": False, "rows": dict.fromkeys(SUBSETS, 60), "constant_coordinates": []}
DESCRIPTION |= {"content_sha256": dict.fromkeys(SUBSETS, "c")}


@pytest.fixture(scope="module", params=[0.02, 20.0], ids=["quantiles are best", "a model is best"])
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files of a small run: a fitted model with a shell, and quantiles that are so far (mm) off."""
    folder = tmp_path_factory.mktemp("run")
    subsets = four_subsets(dict.fromkeys(SUBSETS, 60))
    table, train = folder / "table.parquet", subsets[TRAIN]
    write_table(to_table(subsets), table)
    settings = FitSettings({"degree": 3, "alpha": 1e-6}, skip_constant=True, seed=0, threads=1)
    model = fitted_model(MODELS["ridge"], settings, train)
    joblib.dump(model, folder / "model.joblib")
    record_job(folder / "logs" / "fit_model.log", [folder / "model.joblib"])
    predictions = folder / "ridge_tuned.parquet"
    predict(table, spec=MODELS["ridge"], estimator=model, threads=1, predictions=predictions)
    offsets = np.random.default_rng(0)
    frames = [
        bounds_frame(np.stack([centre - request.param, centre + request.param], axis=-1), subset, level)
        for subset, rows in subsets.items()
        for centre in [rows.positions + request.param * offsets.uniform(-1, 1, rows.positions.shape)]
        for level in (0.8, 0.9)
    ]
    pd.concat(frames[2:]).to_parquet(folder / "quantiles.parquet")
    core = np.argsort(np.linalg.norm(train.commands, axis=1))
    shared = {"core_0": core[:40], "shell_0": core[40:], "centre": np.zeros(2), "scale": np.ones(2)}
    RunArchive(shared, {(RIDGE, "0"): train.positions[core[40:]] + 1.0}).write(folder / "shells.npz")
    outputs = StoredOutputs(
        table,
        predictions={RIDGE: predictions},
        quantiles={GB: folder / "quantiles.parquet"},
        refits=None,
        confidence_levels=[0.8, 0.9],
        shells=folder / "shells.npz",
    )
    choose(outputs, methods=METHODS, runs=[RIDGE], seed=0, regime="auto", choice=folder / "choice.csv")
    best = deployed_choice(folder / "choice.csv")
    assert best is not None
    intervals = {name: folder / f"{name}.parquet" for name in METHODS}
    calibrate(outputs, methods=METHODS, in_domain={RIDGE: METHODS[best["interval_method"]]}, intervals=intervals)
    metrics = folder / "intervals.csv"
    score_intervals(
        table, dataset="arm", methods=METHODS, intervals=intervals, regions={}, outputs=outputs, output=metrics
    )
    errors = {"rmse_mm": 1.0, "mae_mm": 1.0, "euclidean_mean_mm": 1.0, "euclidean_p95_mm": 2.0}
    pd.DataFrame([{"dataset": "arm", **RIDGE._asdict(), "subset": s} | errors for s in SUBSETS]).to_csv(
        folder / "point.csv", index=False
    )
    write_json(folder / "dataset.json", DESCRIPTION)
    write_json(folder / "data_card.json", {"dataset": "arm", "findings": [], "unit_in_file": "mm"})
    build_calibrated_model(
        outputs,
        description=folder / "dataset.json",
        choice=folder / "choice.csv",
        specs=MODELS,
        methods=INTERVAL_METHODS,
        models={RIDGE: folder / "model.joblib"},
        output=folder / "robot.joblib",
    )
    record_job(folder / "logs" / "calibrate.log", [folder / "robot.joblib"])
    return folder


def test_what_is_chosen_and_what_is_deployed_is_said_alike_everywhere(
    run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    candidates, metrics = pd.read_csv(run / "choice.csv"), pd.read_csv(run / "intervals.csv")
    lowest = candidates.loc[candidates["cv_winkler_typical_mm"].idxmin()]
    around = candidates[candidates["model"] == "ridge"]
    held = around.loc[around["cv_winkler_typical_mm"].idxmin()]
    chosen, deployed = ((row["model"], row["preset"], row["interval_method"]) for row in (lowest, held))

    table = interval_choice({"arm": candidates}, metrics)
    for best, said in ((chosen_intervals(table), chosen), (deployed_intervals(table), deployed)):
        assert tuple(best.loc["arm", ["model", "preset", "interval_method"]]) == said
    same = chosen == deployed

    text = headline(None, pd.read_csv(run / "point.csv"), table, [])
    assert f"arm ridge tuned {deployed[2]} " in " ".join(text.split())
    assert (f"chosen is {chosen[2]} ({chosen[0]} {chosen[1]})" in text) == (not same)

    marks = Marks({"arm": {}}, {"arm": DESCRIPTION}, {"arm": {"findings": []}})
    frames = {"interval_choice": table, "interval_metrics": metrics, "point_metrics": pd.read_csv(run / "point.csv")}
    (card,) = robot_cards(frames, {"arm": DESCRIPTION}, TITLES, marks)
    assert card.interval.method == f"{TITLES.methods[deployed[2]]} around {TITLES.run(*deployed[:2])}"
    marked = {TITLES.methods[chosen[2]]: ["chosen"], TITLES.methods[deployed[2]]: ["deployed"]}
    if same:
        marked = {TITLES.methods[chosen[2]]: ["chosen", "deployed"]}
    for grid, place in (
        (choice_grid(table, TITLES, marks, Singles({})), 1),
        (interval_grid(metrics[metrics["subset"] == "test"], TITLES, 0.9, marks, read_choices(frames)), 2),
    ):
        kinds = {row[place].text: [mark.kind for mark in row[place].marks] for row in grid.rows if row[place].marks}
        assert kinds == marked
    leaks = metrics.assign(leak=False)
    words = [row[0].split(", ") for row in interval_table(leaks, table, {"arm": "ARM"}, TITLES).rows]
    assert {row[0]: row[1:] for row in words if row[1:]} == marked

    robot = joblib.load(run / "robot.joblib")
    assert (robot.spec.name, robot.preset, robot.method.name) == deployed
    assert bool(robot.shells) == (held["outside"] == "auto")
    record = logged(run, monkeypatch)
    assert (record.params["model"], record.params["preset"], record.params["interval_method"]) == deployed
    assert f"with intervals by {METHODS[deployed[2]].title}" in record.texts["model_card.md"]
    beyond = metrics[(metrics["interval_method"] == held["outside"]) & (metrics["subset"] == "extrapolation")]
    beyond = beyond[(beyond["coordinate"] == "mean_informative") & (beyond["confidence_level"] == 0.9)]
    assert record.metrics["extrapolation/winkler_mm_90"] == pytest.approx(float(beyond["winkler_mm"].iloc[0]))
    assert summarised(run, table) == dict(
        zip(("model", "preset", "interval_method", "outside"), (*deployed, held["outside"]), strict=True)
    )


def logged(run: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """What `log_champion` puts into the store."""
    put = Mock(return_value="id")
    monkeypatch.setattr(champion, "put", put)
    for name in ("client_of", "_experiment", "sweep", "_version"):
        monkeypatch.setattr(champion, name, Mock())
    campaign = Campaign("nights", 0, "sqlite://")
    files = {"point": "point.csv", "intervals": "intervals.csv", "calibrated_model": "robot.joblib"}
    files |= {"description": "dataset.json", "data_card": "data_card.json"}
    champion.log_champion(campaign, parent="id", **{name: run / file for name, file in files.items()})
    (_, _, record), _ = put.call_args
    return record


def summarised(run: Path, table: pd.DataFrame) -> Any:
    """What campaigns compare as the deployed model."""
    table.to_csv(run / "table.csv", index=False)
    layout = Layout(
        table=f"{run}/table.parquet",
        description=f"{run}/dataset.json",
        data_card=f"{run}/data_card.json",
        predictions=f"{run}/{{model}}_{{preset}}.parquet",
        intervals=f"{run}/{{method}}.parquet",
    )
    config = {"campaign": "nights", "seed": 0, "datasets": ["arm"]}
    out = {"output": run / "summary.json", "rows": run / "rows.parquet"}
    files = {"point": run / "point.csv", "intervals": run / "intervals.csv", "choice": run / "table.csv"}
    summarise(config, layout, **files, **out)
    return read_json(run / "summary.json")["datasets"]["arm"]["deployed"]
