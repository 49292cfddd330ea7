"""Locks of stores, between real processes."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import psutil
import pytest
from mlflow import MlflowClient

from softkin.core.errors import StoreError
from softkin.tracking.lock import PREFIX, PROCESS, _break_if_old, _server_lock, has_ended, locked, this_process
from softkin.tracking.records import CURRENT, KEY
from softkin.tracking.store import Campaign
from tests.workflow.mlflow_server import serving, sqlite

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


def test_a_lock_on_a_server_ends_with_its_process_where_it_ran(campaign: Campaign) -> None:
    """A run that was killed holds up the next one for a moment and not for half an hour."""
    client = MlflowClient(campaign.tracking_uri, campaign.tracking_uri)
    place = this_process().rsplit(" ", 2)[0]
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as other:
        name = f"{place} {other.pid} {psutil.Process(other.pid).create_time():.2f}"
        client.create_registered_model(f"{PREFIX}finger", {PROCESS: name})
        _break_if_old(client, f"{PREFIX}finger")
        assert len(client.search_registered_models()) == 1, "it lives"
        other.kill()
    _break_if_old(client, f"{PREFIX}finger")
    with _server_lock(campaign.tracking_uri, "finger", 0):
        assert client.get_registered_model(f"{PREFIX}finger").tags[PROCESS] == this_process()


def test_numbers_of_processes_count_where_they_were_given_alone() -> None:
    place, number, started = this_process().rsplit(" ", 2)
    assert has_ended(f"{place} {number} {float(started) - 60:.2f}"), "the number was given anew"
    for other in (this_process(), f"another {number} {started}", f"{place[:-2]}0] 1 1.00", "", "a b"):
        assert not has_ended(other)


def test_a_lock_that_another_has_by_now_is_not_deleted(campaign: Campaign) -> None:
    """This process held it beyond its lease."""
    client = MlflowClient(campaign.tracking_uri, campaign.tracking_uri)
    with _server_lock(campaign.tracking_uri, "finger", 1):
        client.delete_registered_model(f"{PREFIX}finger")
        client.create_registered_model(f"{PREFIX}finger", {PROCESS: "another"})
    assert len(client.search_registered_models()) == 1


WRITE = """
import json, sys
from softkin.core.runs import Run
from softkin.tracking.lock import locked
from softkin.tracking.models import log_dataset
from softkin.tracking.store import Campaign
uri, files, runs = json.loads(sys.argv[1])
print("ready", flush=True)
sys.stdin.readline()
with locked(uri, "finger"):
    log_dataset(Campaign("nightly", 5, uri), **files, runs={Run(*run): of_run for run, of_run in runs})
"""


@pytest.fixture(params=["file", "server"])
def shared_store(request: pytest.FixtureRequest, campaign: Campaign, tmp_path: Path) -> Iterator[str]:
    """A store that two people write to."""
    with ExitStack() as stack:
        if request.param == "server":
            yield stack.enter_context(serving(stack.enter_context(sqlite(tmp_path)), tmp_path)).uri
        else:
            yield campaign.tracking_uri


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_two_writers_at_any_gap_leave_each_others_runs_whole(
    shared_store: str, results: dict[str, Any], tmp_path: Path
) -> None:
    """They log different results of the same runs; at the end of each pair every run is there once as current."""
    files = {name: str(path) for name, path in results.items() if name != "runs"}
    client = MlflowClient(shared_store, shared_store)
    for number, gap in enumerate((0.0, 0.5, 1.0, 2.0, 4.0, 6.0)):
        writers = []
        for who in range(2):
            predictions = tmp_path / f"predictions_{number}_{who}.parquet"
            predictions.write_text(f"{number} {who}")
            runs = [[run, of_run | {"predictions": str(predictions)}] for run, of_run in results["runs"].items()]
            command = [sys.executable, "-c", WRITE, json.dumps([shared_store, files, runs])]
            writers.append(subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True))
        for writer in writers:
            assert writer.stdout is not None
            assert writer.stdout.readline() == "ready\n"
        for place, writer in enumerate(writers):
            time.sleep(gap * place)
            assert writer.stdin is not None
            print(file=writer.stdin, flush=True)
        assert [writer.wait(600) for writer in writers] == [0, 0], gap
        for writer in writers:
            writer.communicate()
        experiment = client.get_experiment_by_name("finger")
        assert experiment is not None
        found = client.search_runs([experiment.experiment_id], max_results=1000)
        assert {run.info.status for run in found} == {"FINISHED"}, gap
        of_models = [run for run in found if run.data.tags["kind"] == "model"]
        assert len(of_models) == 2 * (number + 1) * len(results["runs"]), "nothing is deleted"
        current = Counter(run.data.tags[KEY] for run in found if run.data.tags[CURRENT] == "true")
        assert set(current) == {run.data.tags[KEY] for run in found}, gap
        assert set(current.values()) == {1}, gap
