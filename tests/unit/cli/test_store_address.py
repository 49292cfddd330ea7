from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli.store_address import store_address
from softkin.core.errors import StoreError
from softkin.core.files import write_json


def test_it_is_the_store_that_the_last_run_wrote(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_json(tmp_path / "results" / "mlflow_store.json", {"tracking_uri": "sqlite:///nights.db"})
    monkeypatch.setenv("MLFLOW_TRACKING_URI", "http://127.0.0.1:5000")
    assert store_address(tmp_path) == "sqlite:///nights.db"


def test_credentials_come_from_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    secret = "https://me:secret@host/mlflow"
    from softkin.core.urls import without_credentials

    write_json(tmp_path / "results" / "mlflow_store.json", {"tracking_uri": without_credentials(secret)})
    assert "secret" not in store_address(tmp_path)
    monkeypatch.setenv("MLFLOW_TRACKING_URI", secret)
    assert store_address(tmp_path) == secret


def test_a_folder_without_a_run_has_no_store(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="no run has made an MLflow store") as error:
        store_address(tmp_path)
    assert "make run" in str(error.value)
