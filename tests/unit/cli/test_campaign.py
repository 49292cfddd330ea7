"""The command, with a stand-in for Snakemake: what it prints, writes and ends with."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from softkin.cli import campaign
from softkin.cli.workflow_process import Ended
from softkin.core.errors import StoreError
from softkin.core.files import read_json

HOLD = """
import sys, time
from filelock import FileLock
with FileLock(sys.argv[1]):
    print("locked", flush=True)
    time.sleep(60)
"""


@pytest.fixture(autouse=True)
def _stay(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A campaign works in its folder; the test comes back."""
    monkeypatch.chdir(tmp_path)


def ended(code: int = 1, signal: str = "") -> Ended:
    return Ended(code, signal, 1.5, 3, 10)


def test_a_second_campaign_is_told_who_runs_one_since_when(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "results").mkdir()
    lock = tmp_path / "results" / campaign.LOCK
    (tmp_path / "results" / campaign.HOLDER).write_text(json.dumps({"pid": 7, "since": "2026-11-26T02:00:00+00:00"}))
    with subprocess.Popen([sys.executable, "-c", HOLD, str(lock)], stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        other.stdout.readline()
        assert campaign.main(["--directory", str(tmp_path)]) == 75
        other.kill()
    assert "process 7 has run one since 2026-11-26T02:00:00" in capsys.readouterr().err
    assert not (tmp_path / "results" / "verdict.json").exists()


def test_a_workflow_that_fails_is_a_verdict_with_what_its_jobs_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(command: list[str], *, directory: Path, results: Path, refit: bool) -> Ended:
        assert command[-2:] == ["--configfile", str(tmp_path / "more.yaml")]
        assert (directory, results, refit) == (tmp_path, tmp_path / "results", False)
        log = results / "logs" / "prepare" / "finger.log"
        log.parent.mkdir(parents=True)
        log.write_text(
            "2026-11-26 02:00:00,000 INFO reading\n2026-11-26 02:00:01,000 ERROR finger.csv: column u1 is missing\n"
        )
        return ended()

    monkeypatch.setattr(campaign, "run_workflow", failing)
    told = tmp_path / "told.txt"
    notify = f"(echo $SOFTKIN_OUTCOME $SOFTKIN_EXIT_CODE; cat) > '{told}'"
    arguments = ["--directory", str(tmp_path), "--notify", notify, "--configfile", str(tmp_path / "more.yaml")]
    assert campaign.main(arguments) == 1
    verdict = read_json(tmp_path / "results" / "verdict.json")
    assert verdict["outcome"] == "failed"
    assert verdict["reasons"][0] == "prepare/finger: finger.csv: column u1 is missing"
    assert verdict["jobs_run"] == 3
    page = (tmp_path / "results" / "verdict.md").read_text()
    assert "column u1 is missing" in page
    assert told.read_text() == f"failed 1\n{page}"


def test_a_campaign_that_was_stopped_says_by_what(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(campaign, "run_workflow", lambda *_, **__: ended(signal="SIGTERM"))
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    assert read_json(tmp_path / "results" / "verdict.json")["reasons"] == ["It was stopped by SIGTERM."]


def test_a_tracking_server_that_is_gone_hides_no_other_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(*_: object) -> None:
        raise StoreError("the tracking server does not answer", where="http://127.0.0.1:5", fix="start it")

    monkeypatch.setattr(campaign, "run_workflow", lambda *_, **__: ended())
    monkeypatch.setattr(campaign, "log_failure", gone)
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    first, second = read_json(tmp_path / "results" / "verdict.json")["reasons"]
    assert first.startswith("The workflow ended with exit code 1")
    assert "the tracking server does not answer" in second
