"""A real MLflow store in a temporary folder, and result files to log."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from mlflow import MlflowClient

from softkin.core.files import write_json
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS
from softkin.tracking.store import Campaign, client_of, experiment_of
from tests.unit.stores import new_store

DESCRIPTION = {
    "dataset": "finger",
    "title": "FINGER",
    "sha256": "ab" * 32,
    "origin": "published",
    "n_commands": 2,
    "n_markers": 1,
}


@pytest.fixture
def campaign(tmp_path: Path) -> Campaign:
    """A campaign on a store of its own."""
    return Campaign("nightly", seed=5, tracking_uri=new_store(tmp_path / "mlflow.db"))


@pytest.fixture
def client(campaign: Campaign) -> Any:
    """MLflow's client of that store; untyped, since MLflow types as absent what is there."""
    return client_of(campaign.tracking_uri)


@pytest.fixture
def experiment(client: MlflowClient) -> str:
    """An experiment of that store."""
    return experiment_of(client, "finger")


@pytest.fixture
def results(tmp_path: Path) -> dict[str, Any]:
    """Result files of two runs of one dataset."""
    write_json(tmp_path / "dataset.json", DESCRIPTION | {"rows": dict.fromkeys(SUBSETS, 9)})
    finding = {"severity": "leak", "sentence": "Nine rows of test stand in train."}
    write_json(tmp_path / "data_card.json", {"findings": [finding]})
    runs: dict[Run, dict[str, str]] = {}
    rows = []
    for model, preset in (("svr", "paper"), ("svr", "tuned")):
        folder = tmp_path / model / preset
        files = {name: str(folder / f"{name}.json") for name in ("fit", "parameters")}
        write_json(files["fit"], {"params": {"C": 1.0, "kernel": "rbf"}, "target_space": "cartesian"})
        (folder / "predictions.parquet").write_text(f"{model} {preset}")
        files["predictions"] = str(folder / "predictions.parquet")
        (folder / "model.joblib").write_text("fitted")
        files["model"] = str(folder / "model.joblib")
        if preset == "tuned":
            write_json(files["parameters"], {"cv_mae_mm": 0.5, "shell_mae_mm": 0.7, "fingerprint": "f", "n_trials": 3})
            files["trials"] = str(folder / "trials.csv")
            table = pd.DataFrame({"trial": [0, 1, 2], "state": "COMPLETE", "score_mm": [0.9, None, 0.5]})
            table.to_csv(files["trials"], index=False)
        else:
            del files["parameters"]
        runs[Run(model, preset)] = files
        for subset in SUBSETS:
            key = {"dataset": "finger", "subset": subset, "model": model, "preset": preset}
            rows.append(key | {"rmse_mm": 1.5, "euclidean_mean_mm": 2.0, "fit_seconds": 3.0, "predict_us_per_row": 4.0})
    pd.DataFrame(rows).to_csv(tmp_path / "point.csv", index=False)
    (tmp_path / "figures").mkdir()
    shown = [("ranking", "svr", "paper", ""), ("ranking", "svr", "tuned", ""), ("tuning_history", "svr", "tuned", "")]
    shown += [("distribution", "", "", ""), ("intervals_deployed", "svr", "tuned", "scp_mapie")]
    index = pd.DataFrame(shown, columns=["figure", "model", "preset", "interval_method"])
    index.assign(title="t").to_csv(tmp_path / "figures" / "index.csv", index=False)
    for name in index["figure"].unique():
        (tmp_path / "figures" / f"{name}.png").write_text("drawn")
    files = {"description": "dataset.json", "data_card": "data_card.json", "point": "point.csv", "figures": "figures"}
    return {name: tmp_path / file for name, file in files.items()} | {"runs": runs}


@pytest.fixture
def interval_files(tmp_path: Path) -> dict[str, Path]:
    rows = []
    for method in ("qr", "scp_mapie"):
        for subset in ("test", "extrapolation"):
            for coordinate in ("m1_x", "mean_informative", "joint"):
                key: dict[str, Any] = {"dataset": "finger", "subset": subset, "model": "svr", "preset": "tuned"}
                values: dict[str, float] = {
                    "coverage": 0.91,
                    "mean_width_mm": 2.0,
                    "infinite_share": 0.0,
                    "crossing_share": 0.0,
                }
                values |= {
                    "crps_mm": float("nan"),
                    "size_mm": 2.5 if coordinate == "joint" else float("nan"),
                }
                values["winkler_mm"] = float("inf") if coordinate == "joint" else 3.0
                values["winkler_without_gross_mm"] = values["winkler_mm"]
                rows.append(
                    key | {"interval_method": method, "coordinate": coordinate, "confidence_level": 0.9} | values
                )
    pd.DataFrame(rows).to_csv(tmp_path / "intervals.csv", index=False)
    files = {"metrics": "intervals.csv", "figures": "figures"}
    files |= {"description": "dataset.json", "data_card": "data_card.json"}
    return {name: tmp_path / file for name, file in files.items()}


def client_of_store(campaign: Campaign) -> Any:
    """MLflow's client; untyped, since MLflow types as absent what is there."""
    return MlflowClient(campaign.tracking_uri, campaign.tracking_uri)


def snapshot(campaign: Campaign, *, experiment: str = "finger", all_of_them: bool = False) -> dict[str, Any]:
    """Current runs of an experiment by id, or all of them."""
    client = MlflowClient(campaign.tracking_uri)
    experiments = [e.experiment_id for e in client.search_experiments() if e.name == experiment]
    runs = client.search_runs(experiments, "" if all_of_them else "tags.current = 'true'", max_results=1000)
    return {run.info.run_id: run.to_dictionary() for run in runs}
