"""The whole pipeline, run for real."""

from __future__ import annotations

import shlex
import sqlite3
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from mlflow import MlflowClient

from softkin.core.csv_tables import read_csv
from softkin.core.files import read_json
from softkin.core.metrics.interval import fewest_commands
from softkin.core.run_archive import read_run_archive
from softkin.core.runs import PRESETS, SEARCHED, Run
from softkin.core.samples import SUBSETS
from softkin.models import MODELS
from softkin.models.spec import PAPERS_RUN
from softkin.training.refit import FOLDS
from softkin.uncertainty.calibration_data import (
    CalibrationData,
    FoldCalibration,
    PointCalibration,
    PredictiveCalibration,
    QuantileCalibration,
    ShellCalibration,
    SpreadCalibration,
)
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.regions.spec import JOINT_INTERVALS
from tests.conftest import HOUSE
from tests.workflow.conftest import House

pytestmark = pytest.mark.timeout(600)
DATASETS = ("elastica_2023_09", "finger")
DEFAULT = yaml.safe_load((HOUSE / "config" / "config.yaml").read_text())
SMALL = yaml.safe_load((HOUSE / "config" / "test.yaml").read_text())
POOL = {name: MODELS[name] for name in SMALL["models"]}
SEARCHED_POOL = [*POOL, *DEFAULT["ensembles"]]
#: Of each dataset: ensembles have no paper preset.
RUNS = {(m, p) for m in POOL for p in PRESETS} | {(m, p) for m in SEARCHED_POOL for p in SEARCHED}
WITH_SPREAD = [name for name, spec in POOL.items() if spec.spread]
PREDICTIVE = [name for name, spec in POOL.items() if spec.is_predictive]


def refitted_runs(house: House, dataset: str) -> set[Run]:
    """The runs that were refitted on folds: the paper's, and the chosen one where its model is cheap."""
    results = house.work / "results"
    selection = read_csv(results / "tables" / "selection.csv")
    (chosen,) = selection[(selection["dataset"] == dataset) & selection["deployed"]].itertuples()
    is_cheap = chosen.model in POOL and POOL[chosen.model].is_cheap
    wanted = {PAPERS_RUN} | ({Run(chosen.model, chosen.preset)} if is_cheap else set())
    archive = read_run_archive(results / dataset / "refits.npz")
    assert {run for run, part in archive.of_runs if part == FOLDS} == wanted
    return wanted


TIMINGS = ["fit_seconds", "predict_us_per_row"]


def test_point_metrics_have_a_row_for_everything(house: House) -> None:
    table = read_csv(house.work / "results" / "tables" / "point_metrics.csv")
    wanted = {(d, s, m, p) for d in DATASETS for s in SUBSETS for m, p in RUNS}
    assert set(table[["dataset", "subset", "model", "preset"]].itertuples(index=False, name=None)) == wanted
    assert len(table) == len(wanted)
    columns = "rmse_mm,mae_mm,r2,mape_percent,rmse_informative_mm,mae_informative_mm,r2_informative,euclidean_mean_mm"
    assert [*columns.split(","), "euclidean_p95_mm", *TIMINGS, "leak"] == [
        c for c in table.columns if c not in ("dataset", "subset", "model", "preset", "mape_informative_percent")
    ]
    assert not table.isna().any().any()


@pytest.mark.parametrize(("objective", "score"), [("interpolation", "cv_mae_mm"), ("extrapolation", "shell_mae_mm")])
def test_selection_follows_the_score_of_its_objective(house: House, objective: str, score: str) -> None:
    selection = read_csv(house.work / "results" / "tables" / "selection.csv").set_index(["dataset", "objective"])
    for dataset in DATASETS:
        scores = {
            (model, preset): read_json(house.work / "results" / dataset / model / preset / "parameters.json")[score]
            for model in SEARCHED_POOL
            for preset in SEARCHED
        }
        chosen = selection.loc[(dataset, objective)]
        assert chosen[score] == min(scores.values())
        assert (chosen["model"], chosen["preset"]) == min(scores, key=lambda run: scores[run])


def test_the_paper_tables_are_laid_out_and_cut_rows_are_marked(house: House) -> None:
    text = (house.work / "results" / "tables" / "paper_tables.md").read_text()
    for part in ("### Table 2", "### Table 5: comparison on FINGER", "not in the paper", "left rows out"):
        assert part in text
    comparison = read_csv(house.work / "results" / "tables" / "published_comparison.csv")
    assert len(comparison) == 2 * 4 * len(set(POOL) & {"lr", "lasso", "rf", "gb", "xgb", "svr", "gp", "mlp"})
    assert set(comparison["paper_verdict"]) | set(comparison["tuned_verdict"]) <= {"reproduced", "better", "worse"}
    assert comparison["note"].str.contains("left rows out").all()


def test_the_run_ends_with_the_headline(house: House) -> None:
    text = (house.work / "first_run.txt").read_text()
    assert "softkin: forward kinematics" in text
    caution = yaml.safe_load((house.root / "config" / "test.yaml").read_text())["caution"]
    assert f"CAUTION: {caution}" in text
    assert f"{house.work}/results/report.html  " in text
    assert f"{house.work}/results/finger/calibrated_model.joblib  " in text
    assert f"make ui IN={shlex.quote(str(house.work))}  " in text


def test_interval_metrics_have_a_row_for_everything(house: House) -> None:
    table = read_csv(house.work / "results" / "tables" / "interval_metrics.csv")
    keys = ["dataset", "subset", "model", "preset", "interval_method", "coordinate", "confidence_level"]
    assert not table.duplicated(keys).any()
    rows = table["interval_method"].value_counts().to_dict()
    runs, presets = len(RUNS), len(PRESETS)
    n_runs: dict[type[CalibrationData], int] = {
        PointCalibration: runs,
        SpreadCalibration: presets * len(WITH_SPREAD),
        PredictiveCalibration: presets * len(PREDICTIVE),
        # In the presets paper and tuned only:
        QuantileCalibration: 2 * len(SMALL["quantile_models"]),
    }
    on_shells = [name for name in SMALL["interval_methods"] if INTERVAL_METHODS[name].calibrated_on is ShellCalibration]
    assert len({rows.pop(name) for name in on_shells}) == 1
    refitted = [name for name in SMALL["interval_methods"] if INTERVAL_METHODS[name].calibrated_on is FoldCalibration]
    n_refitted = sum(len(refitted_runs(house, dataset)) for dataset in DATASETS)
    assert {rows.pop(name) for name in refitted} == {2 * n_refitted * 6 * 3}
    rest = [name for name in SMALL["interval_methods"] if name not in {*on_shells, *refitted}]
    expected = {name: 2 * 2 * n_runs[INTERVAL_METHODS[name].calibrated_on] * 6 * 3 for name in rest}
    # The paper's quantiles are fitted for its level alone.
    expected["qr"] = 2 * 2 * (1 + 3) * len(SMALL["quantile_models"]) * 6
    joint = dict.fromkeys(SMALL["regions"], 2 * 2 * runs * 3) | {JOINT_INTERVALS: 2 * 2 * 3}
    assert rows == expected | joint
    engines = table[table["interval_method"].str.startswith("scp")].pivot(
        index=[key for key in keys if key != "interval_method"], columns="interval_method", values="winkler_mm"
    )
    np.testing.assert_allclose(engines["scp_mapie"], engines["scp_crepes"], rtol=1e-9)
    text = (house.work / "results" / "tables" / "paper_tables.md").read_text()
    assert "### Table 6" in text
    published = read_csv(house.work / "results" / "tables" / "published_intervals.csv")
    assert len(published) == 8  # FINGER: four methods, coverage and Winkler score
    choice = read_csv(house.work / "results" / "tables" / "interval_choice.csv")
    assert choice.groupby("dataset")["chosen"].sum().to_dict() == dict.fromkeys(DATASETS, 1)
    assert choice["test_winkler_mm"].gt(0).all()
    deployed = choice[choice["deployed"]]
    assert deployed["outside"].tolist() == ["auto", "auto"]
    keys = ["dataset", "model", "preset", "confidence_level"]
    auto = table[(table["interval_method"] == "auto") & (table["coordinate"] == "mean_informative")]
    auto = auto[auto["subset"] == "extrapolation"].set_index(keys)["coverage"]
    np.testing.assert_array_equal(deployed["extrapolation_coverage"], auto.loc[deployed.set_index(keys).index])
    assert published["explanation"].str.contains("nearest single coordinate").all()


def test_every_interval_in_extrapolation_stands_beside_the_oracle(house: House) -> None:
    table = read_csv(house.work / "results" / "tables" / "extrapolation_intervals.csv")
    runs = table.groupby("dataset")[["model", "preset"]].apply(lambda rows: set(map(tuple, rows.to_numpy())))
    for dataset in DATASETS:
        assert ("gb", "paper") in runs[dataset]
        assert ("huber", "outer") in runs[dataset]
        assert len(runs[dataset]) <= 3
        assert (house.work / "results" / dataset / "figures" / "extrapolation.png").is_file()
    assert set(LABELLED_METHODS) | {"scp_mapie", "scp_distance", "auto"} <= set(table["interval_method"])
    scored = table[table["refused"].isna()]
    oracle = scored[scored["interval_method"] == "oracle_constant"]
    assert (oracle["coverage"] >= oracle["confidence_level"]).all()
    np.testing.assert_allclose(scored["winkler_ratio_to_oracle"], scored["winkler_mm"] / scored["oracle_winkler_mm"])
    least = {level: fewest_commands(level) for level in table["confidence_level"].unique()}
    assert (table["assessable"] == (table["n_commands"] >= table["confidence_level"].map(least))).all()
    promised = table[(table["subset"] == "extrapolation") & (table["guarantee"] != "no guarantee")]
    assert set(promised["interval_method"]) == {"oracle_constant", "few_labels", "few_labels_distance", "adaptive"}


def test_the_profile_is_found_without_being_named(house: House) -> None:
    assert "profiles/default" in (house.work / "first_run.txt").read_text()


def test_every_job_left_its_log(house: House) -> None:
    logs = {path.relative_to(house.work / "results" / "logs") for path in (house.work / "results").rglob("*.log")}
    assert {Path("fit_model/finger/gp.log"), Path("calibrate/finger.log"), Path("track/finger.log")} <= logs


def test_the_store_holds_a_child_run_per_model_and_preset(house: House) -> None:
    client = MlflowClient(f"sqlite:///{house.work / 'mlflow.db'}")
    for dataset in DATASETS:
        experiment = client.get_experiment_by_name(dataset)
        assert experiment is not None
        runs = client.search_runs([experiment.experiment_id], max_results=1000)
        nested = [run for run in runs if run.data.tags["kind"] == "intervals"]
        # SCP by two engines and by distance, and regions, around every run; SCP by spread and the model's own interval
        # around models that have one; CV+ around refitted ones; QR and CQR by quantile regressors, in two presets;
        # two methods calibrated on shells, around the paper's run, the chosen one and the robust one.
        archive = read_run_archive(house.work / "results" / dataset / "shells.npz")
        on_shells = {run for run, _ in archive.of_runs}
        assert {("gb", "paper"), ("huber", "outer")} <= on_shells
        assert len(on_shells) <= 3
        around_models = 4 * len(RUNS) + (len(WITH_SPREAD) + len(PREDICTIVE)) * 3 + len(refitted_runs(house, dataset))
        of_regressors = 2 * 2 * len(SMALL["quantile_models"])
        assert len(nested) == around_models + of_regressors + 2 * len(on_shells)
        assert {run.data.tags["mlflow.parentRunId"] for run in nested} <= {run.info.run_id for run in runs}
        parents = [run for run in runs if "mlflow.parentRunId" not in run.data.tags]
        assert len(parents) == 1
        children = [run for run in runs if run.data.tags.get("mlflow.parentRunId") == parents[0].info.run_id]
        children = [run for run in children if run.data.tags["kind"] == "model"]
        names = {(run.data.tags["model"], run.data.tags["preset"]) for run in children}
        assert names == RUNS
        assert len(children) == len(names)


def test_a_second_run_does_nothing(house: House) -> None:
    house.looking()  # Snakemake touches what a job has recorded: the first look records these times
    before = {path: path.stat().st_mtime_ns for path in (house.work / "results").rglob("*") if path.is_file()}
    with sqlite3.connect(house.work / "mlflow.db") as store:
        runs_before = store.execute("select run_uuid, lifecycle_stage from runs order by 1").fetchall()
    status, output = house.looking()
    assert status == 0, output
    assert "softkin: nothing was to be done" in output
    assert "softkin: forward kinematics" in output
    assert f"{house.work}/results/report.html  " in output
    assert {p: p.stat().st_mtime_ns for p in (house.work / "results").rglob("*") if p.is_file()} == before
    with sqlite3.connect(house.work / "mlflow.db") as store:
        assert store.execute("select run_uuid, lifecycle_stage from runs order by 1").fetchall() == runs_before


def test_more_trials_search_every_model_anew_and_prepare_nothing(house: House, tmp_path: Path) -> None:
    (tmp_path / "more.yaml").write_text("tuning: {n_trials: 6}")
    jobs = house.jobs(tmp_path / "more.yaml")
    assert sum(rule == "fit_model" for rule, _ in jobs) == 2 * len(POOL)
    assert not {"prepare", "audit", "fit_quantiles"} & {rule for rule, _ in jobs}


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--config", "tuning={n_trails: 3}"], "did you mean 'n_trials'?"),
        (["--config", "datasets=[fingr]"], "did you mean 'finger'?"),
        (["--config", "models=[svm]"], "did you mean 'svr'?"),
    ],
)
def test_a_typo_stops_the_run_with_its_likely_spelling(house: House, options: list[str], says: str) -> None:
    status, output = house.looking("--dry-run", *options)
    assert status != 0
    assert says in output
    assert "Traceback" not in output


def test_predictions_do_not_depend_on_the_number_of_cores_or_the_run(house: House, tmp_path: Path) -> None:
    """Another folder, one core: the same bits, from which all tables are made."""
    files = [f"results/finger/{model}/{preset}/predictions.parquet" for model in ("gb", "gp") for preset in PRESETS]
    done = house.forked(*files, cores=1, work=tmp_path)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert "Error" not in done.stdout + done.stderr
    assert not (tmp_path / "results" / "tables").exists(), "files can be asked for one by one"
    for file in files:
        again, first = pd.read_parquet(tmp_path / file), pd.read_parquet(house.work / file)
        pd.testing.assert_frame_equal(again, first, check_exact=True)
