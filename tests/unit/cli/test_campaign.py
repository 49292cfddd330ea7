"""The command, with a stand-in for Snakemake: what it prints, writes and ends with."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from filelock import FileLock
from mlflow.exceptions import MlflowException

from softkin.campaigns.verdict import Verdict
from softkin.cli import campaign, judging
from softkin.cli.workflow_process import Ended
from softkin.core.errors import StoreError
from softkin.core.files import read_json, write_json

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
    assert "process 7 since 2026-11-26T02:00:00" in capsys.readouterr().err
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


@pytest.mark.parametrize("place", ["results", "results/verdict.json", "results/verdict.md", "results/campaign.lock"])
def test_what_cannot_be_written_is_one_message(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], place: str
) -> None:
    """A file where a folder belongs, folders where files belong: somebody is told nevertheless."""
    monkeypatch.setattr(campaign, "run_workflow", lambda *_, **__: ended())
    (tmp_path / place).parent.mkdir(exist_ok=True)
    (tmp_path / place).write_text("") if place == "results" else (tmp_path / place / "full").mkdir(parents=True)
    assert campaign.main(["--directory", str(tmp_path), "--notify", f"cat > '{tmp_path}/told'"]) == 1
    assert "# The campaign failed" in (tmp_path / "told").read_text()
    (said,) = capsys.readouterr().err.strip().split("softkin: ")[1:]
    assert place.rpartition("/")[2] in said
    assert "fix: " in said
    assert campaign.main(["--directory", str(tmp_path / "nowhere")]) == 1
    assert "nowhere: no such file or directory" in capsys.readouterr().err


def test_a_campaign_that_was_stopped_says_by_what(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(campaign, "run_workflow", lambda *_, **__: ended(signal="SIGTERM"))
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    assert read_json(tmp_path / "results" / "verdict.json")["reasons"] == ["It was stopped by SIGTERM."]


def test_a_campaign_that_is_stopped_while_it_is_judged_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As a library would see it that tries again whatever happens."""

    def stubborn(*_: object, **__: object) -> Verdict:
        for _attempt in range(2):
            with suppress(Exception):
                os.kill(os.getpid(), signal.SIGTERM)
                time.sleep(5)
        pytest.fail("the campaign goes on")

    monkeypatch.setattr(campaign, "run_workflow", lambda *_, **__: ended(0))
    monkeypatch.setattr(judging, "judge_results", stubborn)
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    reasons = read_json(tmp_path / "results" / "verdict.json")["reasons"]
    assert reasons == ["It was stopped by SIGTERM while its results were judged."]


def test_a_campaign_that_was_killed_leaves_no_verdict_of_the_one_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Killed(BaseException):
        pass

    def killed(*_: object, **__: object) -> Ended:
        raise Killed

    (tmp_path / "results").mkdir()
    write_json(tmp_path / "results" / "verdict.json", {"outcome": "same", "exit_code": 0})
    monkeypatch.setattr(campaign, "run_workflow", killed)
    with pytest.raises(Killed):
        campaign.main(["--directory", str(tmp_path)])
    verdict = read_json(tmp_path / "results" / "verdict.json")
    assert (verdict["outcome"], verdict["exit_code"]) == ("unfinished", 1)
    page = (tmp_path / "results" / "verdict.md").read_text()
    assert page.startswith("# The campaign goes on, or was killed\n\n- It began at 20")


def test_a_tracking_server_that_is_gone_hides_no_other_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(*_: object) -> None:
        raise StoreError("the tracking server does not answer", where="http://127.0.0.1:5", fix="start it")

    monkeypatch.setattr(campaign, "run_workflow", lambda *_, **__: ended())
    monkeypatch.setattr(judging, "log_failure", gone)
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    first, second = read_json(tmp_path / "results" / "verdict.json")["reasons"]
    assert first.startswith("The workflow ended with exit code 1")
    assert "the tracking server does not answer" in second


def test_a_torn_note_of_who_holds_the_lock_is_no_traceback(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / campaign.HOLDER).write_text('{"pid": 7, "si')
    with FileLock(tmp_path / "results" / campaign.LOCK):
        assert campaign.main(["--directory", str(tmp_path)]) == 75
    assert "process unknown since an unknown time" in capsys.readouterr().err


@pytest.mark.parametrize("code", [0, 1])
def test_a_store_that_cannot_be_used_is_a_verdict(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int) -> None:
    """Whether the workflow went well or not: it says why, and what the jobs said comes first."""
    monkeypatch.setattr(campaign, "run_workflow", lambda *_, **__: ended(code))
    (tmp_path / "results" / "tables").mkdir(parents=True)
    write_json(tmp_path / "results" / "tables" / "summary.json", {})
    write_json(tmp_path / "results" / "mlflow_store.json", {"tracking_uri": "sqlite:///mlflow.db"})
    (tmp_path / "mlflow.db").write_text("a note of mine\n" * 100)
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    reasons = read_json(tmp_path / "results" / "verdict.json")["reasons"]
    assert "mlflow.db: this file is no database" in reasons[-1]
    assert len(reasons) == 1 + code


def test_an_error_of_mlflow_is_a_verdict_and_a_defect_is_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def raising(error: Exception) -> Callable[..., Verdict]:
        def judge(*_: object, **__: object) -> Verdict:
            raise error

        return judge

    monkeypatch.setattr(campaign, "run_workflow", lambda *_, **__: ended(0))
    monkeypatch.setattr(judging, "judge_results", raising(MlflowException("API request failed")))
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    (reason,) = read_json(tmp_path / "results" / "verdict.json")["reasons"]
    assert reason.startswith("the MLflow store: mlflow says: API request failed")
    monkeypatch.setattr(judging, "judge_results", raising(ZeroDivisionError()))
    with pytest.raises(ZeroDivisionError):
        campaign.main(["--directory", str(tmp_path)])


def test_a_clock_that_was_set_back_takes_no_reason_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The logs of jobs are then older than the campaign."""

    def failing(*_: object, results: Path, **__: object) -> Ended:
        log = results / "logs" / "prepare.log"
        log.parent.mkdir(parents=True)
        log.write_text("2026-11-26 02:00:01,000 ERROR finger.csv: column u1 is missing\n")
        os.utime(log, (0, 0))
        return ended()

    monkeypatch.setattr(campaign, "run_workflow", failing)
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    assert "results/logs and .snakemake/log say more" in read_json(tmp_path / "results" / "verdict.json")["reasons"][-1]
