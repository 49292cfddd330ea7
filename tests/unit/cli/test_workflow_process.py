"""A child process in place of Snakemake."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from pathlib import Path

import psutil
import pytest

from softkin.cli import workflow_process
from softkin.cli.workflow_process import run_workflow

COUNT = "import json, pathlib; pathlib.Path('results/logs').mkdir(parents=True, exist_ok=True); "
COUNT += "pathlib.Path('results/logs/jobs.json').write_text(json.dumps({'run': 3, 'all': 13})); "


def command(code: str) -> list[str]:
    return [sys.executable, "-c", code]


def test_it_says_how_many_jobs_ran_and_what_they_took(tmp_path: Path) -> None:
    busy = COUNT + "sum(i * i for i in range(3_000_000))"
    ended = run_workflow(command(busy), directory=tmp_path, results=tmp_path / "results", refit=False)
    assert (ended.exit_code, ended.signal, ended.jobs_run, ended.jobs_reused) == (0, "", 3, 10)
    assert ended.cpu_seconds > 0.05
    nothing = run_workflow(command("pass"), directory=tmp_path, results=tmp_path / "results", refit=False)
    assert (nothing.jobs_run, nothing.jobs_reused) == (0, 13)
    again = run_workflow(command("pass"), directory=tmp_path, results=tmp_path / "results", refit=False)
    assert (again.jobs_run, again.jobs_reused) == (0, 13)


def test_a_workflow_of_which_nothing_is_known_reuses_an_unknown_number(tmp_path: Path) -> None:
    (tmp_path / "results").mkdir()
    ended = run_workflow(command("raise SystemExit(7)"), directory=tmp_path, results=tmp_path / "results", refit=False)
    assert (ended.exit_code, ended.jobs_run, ended.jobs_reused) == (7, 0, None)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_a_signal_ends_the_workflow_with_its_jobs(
    number: signal.Signals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also jobs that do not listen, by force."""
    monkeypatch.setattr(workflow_process, "GRACE", 1.0)
    (tmp_path / "results").mkdir()
    deaf = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(60)"
    code = f"import subprocess, sys; job = subprocess.Popen([sys.executable, '-c', {deaf!r}]); "
    code += "open('pid', 'w').write(str(job.pid)); open('ready', 'w').close(); job.wait()"

    def stop() -> None:
        while not (tmp_path / "ready").exists():
            time.sleep(0.05)
        time.sleep(0.3)
        os.kill(os.getpid(), number)

    threading.Thread(target=stop).start()
    started = time.monotonic()
    ended = run_workflow(command(code), directory=tmp_path, results=tmp_path / "results", refit=False)
    assert ended.signal == number.name
    assert ended.exit_code != 0
    assert time.monotonic() - started < 20
    job = int((tmp_path / "pid").read_text())
    deadline = time.monotonic() + 10
    while psutil.pid_exists(job) and psutil.Process(job).status() != psutil.STATUS_ZOMBIE:
        assert time.monotonic() < deadline, "the job lives on"
        time.sleep(0.05)


@pytest.mark.parametrize(("code", "left"), [("new", "new"), ("fails", "old")])
def test_studies_start_anew_and_come_back_where_the_workflow_fails(code: str, left: str, tmp_path: Path) -> None:
    studies = tmp_path / "results" / "studies"
    studies.mkdir(parents=True)
    (studies / "lr.journal").write_text("old")
    write = "import pathlib; p = pathlib.Path('results/studies'); assert not p.exists(); p.mkdir(); "
    write += "(p / 'lr.journal').write_text('new'); "
    write += "raise SystemExit(1)" if code == "fails" else ""
    run_workflow(command(write), directory=tmp_path, results=tmp_path / "results", refit=True)
    assert (studies / "lr.journal").read_text() == left
    assert [path.name for path in studies.parent.iterdir() if path.name.startswith("studies")] == ["studies"]


@pytest.mark.parametrize("refit", [False, True])
def test_studies_that_a_killed_refit_put_aside_come_back(refit: bool, tmp_path: Path) -> None:
    """But for those that it has begun anew; and the next refit is no traceback."""
    studies, aside = (tmp_path / "results" / name / "finger" for name in ("studies", "studies_before_refit"))
    for folder, names in ((studies, "a"), (aside, "ab")):
        folder.mkdir(parents=True)
        for name in names:
            (folder / f"{name}.journal").write_text(folder.parent.name)
    run_workflow(command("raise SystemExit(1)"), directory=tmp_path, results=tmp_path / "results", refit=refit)
    assert {path.name: path.read_text() for path in studies.iterdir()} == {
        "a.journal": "studies",
        "b.journal": "studies_before_refit",
    }
    assert not aside.parent.exists()


@pytest.mark.parametrize("torn", ["", '{"run": 3, "al', "[]"])
def test_a_count_that_was_torn_by_a_kill_is_unknown(tmp_path: Path, torn: str) -> None:
    (tmp_path / "results" / "logs").mkdir(parents=True)
    (tmp_path / "results" / "logs" / "jobs.json").write_text(torn)
    ended = run_workflow(command("pass"), directory=tmp_path, results=tmp_path / "results", refit=False)
    assert (ended.exit_code, ended.jobs_run, ended.jobs_reused) == (0, 0, None)
