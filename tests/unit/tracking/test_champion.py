"""The registered model, loaded from a real store and registry in a temporary folder."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import joblib
import mlflow.pyfunc
import numpy as np
import pandas as pd
import pytest
from mlflow import MlflowClient
from mlflow.exceptions import MlflowException

from softkin.core.distributions import installed
from softkin.core.files import write_json
from softkin.tracking import records
from softkin.tracking.champion import log_champion
from softkin.tracking.store import Campaign
from tests.conftest import bending_arm
from tests.unit.tracking.conftest import client_of_store
from tests.unit.tracking.robots import DESCRIPTION, champion_files, interval_metrics, put_model, robot, with_shells

NAME = "softkin-finger"


@pytest.fixture(autouse=True)
def registry(campaign: Campaign, monkeypatch: pytest.MonkeyPatch) -> None:
    """Models are loaded from the store of the test."""
    monkeypatch.setenv("MLFLOW_TRACKING_URI", campaign.tracking_uri)
    monkeypatch.setattr(sys, "path", [*sys.path])  # loading a model adds its code to it


@pytest.fixture
def files(tmp_path: Path) -> dict[str, Any]:
    return champion_files(tmp_path)


def alias(client: Any, name: str = "candidate") -> str:
    return str(client.get_model_version_by_alias(NAME, name).version)


def test_the_champion_predicts_what_the_calibrated_model_predicts(campaign: Campaign, files: dict[str, Any]) -> None:
    log_champion(campaign, **files)
    served = mlflow.pyfunc.load_model(f"models:/{NAME}@champion")
    expected = joblib.load(files["calibrated_model"])
    commands = bending_arm(20, seed=9).commands
    for params, level in ((None, 0.9), ({"confidence_level": 0.8}, 0.8)):
        answer = served.predict(pd.DataFrame(commands[:, ::-1], columns=["u2", "u1"]), params=params)
        parts = ("y_pred", "lower", "upper", "joint_lower", "joint_upper")
        assert list(answer) == [f"{part}_m1_{axis}" for part in parts for axis in "xyz"]
        np.testing.assert_array_equal(answer.filter(like="y_pred"), expected.predict(commands))
        bounds = expected.intervals(commands, [level])[0]
        joint = np.asarray(expected.joint_intervals(commands, level).bounds)
        for prefix, wanted in (("", bounds), ("joint_", joint)):
            np.testing.assert_array_equal(answer.filter(regex=f"^{prefix}lower"), wanted[..., 0])
            np.testing.assert_array_equal(answer.filter(regex=f"^{prefix}upper"), wanted[..., 1])
    np.testing.assert_array_equal(served.unwrap_python_model().model.box(0.9), expected.box(0.9))
    with pytest.raises(MlflowException, match="missing inputs"):
        served.predict(pd.DataFrame({"u1": [0.0]}))


def test_it_comes_with_signature_example_requirements_and_its_own_code(
    campaign: Campaign, files: dict[str, Any]
) -> None:
    log_champion(campaign, **files)
    served = mlflow.pyfunc.load_model(f"models:/{NAME}@champion")
    assert served.metadata.signature.inputs.input_names() == ["u1", "u2"]
    assert served.metadata.signature.params.params[0].default == 0.9
    assert served.input_example.shape == (3, 2)
    requirements = mlflow.pyfunc.get_model_dependencies(f"models:/{NAME}@champion", format="pip")
    for name in ("crepes", "xgboost"):  # as the distribution that is installed
        assert "==".join(installed(name)) in Path(requirements).read_text().splitlines()
    code = (
        f"import mlflow, pandas; model = mlflow.pyfunc.load_model('models:/{NAME}@champion');"
        "model.predict(model.input_example); import softkin; print(softkin.__file__)"
    )
    elsewhere = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert elsewhere.returncode == 0, elsewhere.stderr[-2000:]
    assert elsewhere.stdout.strip().endswith("/artifacts/code/softkin/__init__.py")


def test_the_card_is_that_of_version_and_run(campaign: Campaign, files: dict[str, Any], tmp_path: Path) -> None:
    log_champion(campaign, **files)
    client = client_of_store(campaign)
    version = client.get_model_version_by_alias(NAME, "champion")
    assert "| test | 0.250 | 0.500 | 0.125 | 92.0 % | 2.00 |" in version.description
    assert 'load_model("models:/softkin-finger@champion")' in version.description
    run = client.get_run(version.run_id)
    assert run.data.tags["mlflow.note.content"] == version.description
    assert run.data.metrics["test/coverage_90"] == 0.92
    assert f"models:/{run.outputs.model_outputs[0].model_id}" == version.source
    card = client.download_artifacts(version.run_id, "model_card.md", str(tmp_path))
    assert Path(card).read_text() == version.description
    write_json(files["description"], DESCRIPTION | {"origin": "stand-in"})
    log_champion(campaign, **files)
    assert "STAND-IN" in client.get_model_version_by_alias(NAME, "candidate").description


def test_the_same_content_is_no_new_version(campaign: Campaign, files: dict[str, Any]) -> None:
    assert log_champion(campaign, **files) == "1"
    assert log_champion(campaign, **files | {"parent": "another"}) == "1"
    client = client_of_store(campaign)
    (version,) = client.search_model_versions(f"name = '{NAME}'")
    assert client.get_run(version.run_id).data.tags["runs_of_its_dataset"] == "the-campaign"


@pytest.mark.parametrize("call", ["log_model_artifacts", "finalize_logged_model", "create_model_version"])
def test_a_model_that_was_cut_off_is_removed_and_made_again(
    campaign: Campaign, files: dict[str, Any], monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    """Killed before it is there, before it is said to be there, and before it is registered."""

    def killed(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as context:
        context.setattr(MlflowClient, call, killed)
        with pytest.raises(KeyboardInterrupt):
            log_champion(campaign, **files)
    assert log_champion(campaign, **files) == "1"
    client = client_of_store(campaign)
    (version,) = client.search_model_versions(f"name = '{NAME}'")
    experiment = client.get_run(version.run_id).info.experiment_id
    (model,) = client.search_logged_models([experiment])
    assert f"models:/{model.model_id}" == version.source
    assert str(model.status) == "READY"


@pytest.mark.parametrize(
    "change",
    [
        lambda files: put_model(files["calibrated_model"], robot(seed=1)),
        lambda files: write_json(files["data_card"], {"findings": []}),
    ],
    ids=["another model", "another card"],
)
def test_other_content_is_a_candidate_and_the_first_stays_champion(
    campaign: Campaign, files: dict[str, Any], change: Callable[[dict[str, Any]], object]
) -> None:
    log_champion(campaign, **files)
    commands = bending_arm(5, seed=9).commands
    before = joblib.load(files["calibrated_model"]).predict(commands)
    change(files)
    assert log_champion(campaign, **files) == "2"
    client = client_of_store(campaign)
    assert (alias(client), alias(client, "champion")) == ("2", "1")
    assert client.get_model_version(NAME, "1").tags["promoted_because"] == "it is the first version"
    named = pd.DataFrame(commands, columns=["u1", "u2"])
    old, new = (mlflow.pyfunc.load_model(f"models:/{NAME}/{version}") for version in (1, 2))
    np.testing.assert_array_equal(old.predict(named).filter(like="y_pred"), before)
    expected = joblib.load(files["calibrated_model"]).predict(commands)
    np.testing.assert_array_equal(new.predict(named).filter(like="y_pred"), expected)


def test_a_result_that_returns_gets_its_version_back(
    campaign: Campaign, files: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wherever it stands among the pages of versions."""
    monkeypatch.setattr(records, "PAGE", 1)
    log_champion(campaign, **files)
    assert log_champion(replace(campaign, name="weekly"), **files) == "2"
    assert log_champion(campaign, **files) == "1"
    assert alias(client_of_store(campaign)) == "1"


def test_a_model_with_shells_is_scored_by_the_intervals_that_it_gives(
    campaign: Campaign, files: dict[str, Any]
) -> None:
    put_model(files["calibrated_model"], with_shells(robot()))
    everywhere = interval_metrics("auto").assign(coverage=0.75)
    everywhere = everywhere[everywhere["coordinate"] != "joint"]
    pd.concat([interval_metrics(), everywhere]).to_csv(files["intervals"], index=False)
    log_champion(campaign, **files)
    client = client_of_store(campaign)
    run = client.get_run(client.get_model_version_by_alias(NAME, "champion").run_id)
    assert run.data.metrics["extrapolation/coverage_90"] == 0.75
    assert run.data.metrics["test/joint_coverage_90"] == pytest.approx(0.91)
    assert run.data.metrics["test/joint_size_mm_90"] == 4.0
    assert run.data.tags["interval_method"] == "scp_spread"


def test_an_infinite_width_is_a_word_and_no_metric(campaign: Campaign, files: dict[str, Any]) -> None:
    """Of a robot that has too few rows for the level."""
    table = interval_metrics().assign(mean_width_mm=np.inf, winkler_mm=np.inf)
    table.to_csv(files["intervals"], index=False)
    log_champion(campaign, **files)
    client = client_of_store(campaign)
    run = client.get_run(client.get_model_version_by_alias(NAME, "champion").run_id)
    assert "test/coverage_90" in run.data.metrics
    assert max(run.data.metrics.values()) < 100
    subsets = ("extrapolation", "test")
    assert run.data.tags["infinite"] == ", ".join(
        f"{subset}/{name}_90" for subset in subsets for name in ("mean_width_mm", "winkler_mm")
    )
