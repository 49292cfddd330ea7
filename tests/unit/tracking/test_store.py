"""Against a real MLflow store in a temporary folder."""

from __future__ import annotations

import os
import signal
import warnings
from collections.abc import Callable
from pathlib import Path

import mlflow
import pytest
from mlflow import MlflowClient
from mlflow.entities import ViewType

from softkin.core.errors import StoreError
from softkin.core.files import write_json
from softkin.tracking.store import Campaign, client_of, common_tags, create_store, experiment_of, read_description


def test_a_lost_store_is_an_error_with_a_fix(tmp_path: Path) -> None:
    uri = f"sqlite:///{tmp_path / 'none.db'}"
    with pytest.raises(StoreError, match="gone") as error:
        client_of(uri)
    assert error.value.where == uri
    assert "make store" in str(error.value.fix)
    assert not (tmp_path / "none.db").exists()


def started(action: Callable[[], object]) -> int:
    """A process that does this and ends; it need not import MLflow, which takes longer than most actions."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # the child runs no other thread
        child = os.fork()
    if child:
        return child
    try:
        action()
        os._exit(0)
    finally:
        os._exit(1)


def ended(child: int) -> int:
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def test_four_processes_may_create_the_store_at_once(tmp_path: Path) -> None:
    address = f"sqlite:///{tmp_path / 'mlflow.db'}"
    assert [ended(child) for child in [started(lambda: create_store(address)) for _ in range(4)]] == [0, 0, 0, 0]
    client = MlflowClient(f"sqlite:///{tmp_path / 'mlflow.db'}")
    assert [e.name for e in client.search_experiments(view_type=ViewType.ALL)] == ["Default"]


def test_a_description_has_the_findings_of_the_data_card(tmp_path: Path) -> None:
    write_json(tmp_path / "dataset.json", {"dataset": "finger"})
    write_json(tmp_path / "data_card.json", {"findings": [], "is_leaking": False})
    described = read_description(tmp_path / "dataset.json", tmp_path / "data_card.json")
    assert described == {"dataset": "finger", "findings": []}


@pytest.mark.parametrize(("severity", "leak"), [("leak", "true"), ("warning", "false")])
def test_tags_say_where_the_data_come_from_and_whether_they_leak(campaign: Campaign, severity: str, leak: str) -> None:
    description = {"dataset": "finger", "sha256": "ab", "origin": "published", "findings": [{"severity": severity}]}
    assert common_tags(campaign, description) == {
        **{"campaign": "nightly", "dataset": "finger", "data_sha256": "ab", "origin": "published", "seed": "5"},
        "leak": leak,
    }


def test_a_deleted_experiment_comes_back(client: MlflowClient, experiment: str) -> None:
    client.delete_experiment(experiment)
    assert experiment_of(client, "finger") == experiment
    assert client.get_experiment(experiment).lifecycle_stage == "active"


def test_the_store_becomes_the_default_of_mlflow(campaign: Campaign, tmp_path: Path) -> None:
    """Also where its name is no plain one: what asks the default store would make another in the working folder."""
    folder = tmp_path / "Roboter für 2 Ärzte \U0001f916"
    folder.mkdir()
    uri = f"sqlite:///{folder / 'nights.db'}"
    Path(campaign.tracking_uri.removeprefix("sqlite:///")).rename(folder / "nights.db")
    client_of(uri)
    assert (mlflow.get_tracking_uri(), mlflow.get_registry_uri()) == (uri, uri)


def test_a_store_whose_making_was_killed_is_made_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """MLflow's own way leaves half of its tables under the store's name, which no later run can open."""
    address = f"sqlite:///{tmp_path / 'mlflow.db'}"
    with monkeypatch.context() as patched:
        patched.setattr("mlflow.store.db.utils._upgrade_db", lambda _: os.kill(os.getpid(), signal.SIGKILL))
        assert ended(started(lambda: create_store(address))) == -signal.SIGKILL
    (half,) = tmp_path.glob(".mlflow.db.*.part")
    assert half.stat().st_size > 0
    assert not (tmp_path / "mlflow.db").exists()
    create_store(address)
    assert [e.name for e in client_of(address).search_experiments()] == ["Default"]
    assert not list(tmp_path.glob(".mlflow.db.*"))
