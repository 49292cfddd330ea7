"""Locks of stores, between real processes."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest
from mlflow import MlflowClient

from softkin.core.errors import StoreError
from softkin.tracking import Campaign
from softkin.tracking.lock import PREFIX, _break_if_old, _server_lock, locked

HOLD = """
import sys, time
from softkin.tracking.lock import locked
with locked(sys.argv[1], "finger"):
    print("locked", flush=True)
    time.sleep(60)
"""


def test_a_second_process_waits_until_the_first_is_gone(tmp_path: Path) -> None:
    uri = f"sqlite:///{tmp_path / 'mlflow.db'}"
    with subprocess.Popen([sys.executable, "-c", HOLD, uri], stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "locked\n"
        with (
            pytest.raises(StoreError, match="another process has logged") as error,
            locked(uri, "finger", patience=0.1),
        ):
            pytest.fail("two processes have the lock")
        assert "finger.lock" in str(error.value)
        with locked(uri, "abaqus", patience=0.1):
            pass
        other.kill()  # a process that dies leaves no lock
    with locked(uri, "finger", patience=5):
        pass


def test_a_server_has_one_lock_of_a_name(campaign: Campaign, monkeypatch: pytest.MonkeyPatch) -> None:
    """The database behind the server decides: here that of a file, asked as a server is."""
    monkeypatch.setattr("softkin.tracking.lock.PAUSE", 0.01)
    uri = campaign.tracking_uri
    with _server_lock(uri, "finger", 1):
        with pytest.raises(StoreError, match="another process"), _server_lock(uri, "finger", 0.05):
            pytest.fail("two processes have the lock")
        with _server_lock(uri, "abaqus", 1):
            pass
    assert MlflowClient(uri, uri).search_registered_models() == []


def test_a_lock_on_a_server_ends_with_its_lease(campaign: Campaign, monkeypatch: pytest.MonkeyPatch) -> None:
    client = MlflowClient(campaign.tracking_uri, campaign.tracking_uri)
    client.create_registered_model(f"{PREFIX}finger", {"holder": "a machine that is gone"})
    _break_if_old(client, f"{PREFIX}finger")
    assert len(client.search_registered_models()) == 1
    monkeypatch.setattr("softkin.tracking.lock.LEASE", 0.01)
    time.sleep(0.02)
    _break_if_old(client, f"{PREFIX}finger")
    assert client.search_registered_models() == []
    _break_if_old(client, f"{PREFIX}finger")
