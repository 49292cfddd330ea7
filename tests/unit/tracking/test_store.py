"""Against a real MLflow store in a temporary folder."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from mlflow import MlflowClient
from mlflow.entities import ViewType

from softkin.core.errors import SoftkinError
from softkin.tracking import Campaign, log_dataset


def test_a_lost_store_is_an_error_with_a_mend(tmp_path: Path, results: dict[str, Any]) -> None:
    lost = Campaign("nightly", 0, f"sqlite:///{tmp_path / 'none.db'}", str(tmp_path))
    with pytest.raises(SoftkinError, match="make store"):
        log_dataset(lost, **results)
    assert not (tmp_path / "none.db").exists()


def test_four_processes_may_create_the_store_at_once(tmp_path: Path) -> None:
    code = f"from softkin.tracking import create_store; create_store('sqlite:///{tmp_path / 'mlflow.db'}')"
    processes = [subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL) for _ in range(4)]
    assert [process.wait() for process in processes] == [0, 0, 0, 0]
    client = MlflowClient(f"sqlite:///{tmp_path / 'mlflow.db'}")
    assert [e.name for e in client.search_experiments(view_type=ViewType.ALL)] == ["Default"]
