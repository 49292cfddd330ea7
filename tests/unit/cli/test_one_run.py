"""One run at a time in a folder, with real processes."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from softkin.cli.one_run import OneRun, clear, end, only_looks, orphans_of
from softkin.core.errors import ConfigError

TAKE = """
import sys, time
from softkin.cli.one_run import OneRun
run = OneRun.of(sys.argv[1])
run.take()
print("taken", flush=True)
time.sleep(60)
"""
#: A job as Snakemake starts it: a script from its folder, here with a child of its own.
JOB = "import subprocess, time; subprocess.Popen(['sleep', '60']); time.sleep(60)"


def started_job(folder: Path) -> subprocess.Popen[bytes]:
    script = folder / ".snakemake" / "scripts" / "tmp1.fit_model.py"
    script.parent.mkdir(parents=True, exist_ok=True)
    script.write_text(JOB)
    # In a session of its own, started by a shell that ends: nobody above it is Snakemake.
    command = f"exec {shlex.quote(sys.executable)} {script.relative_to(folder)} fit"
    return subprocess.Popen(["sh", "-c", command], cwd=folder, start_new_session=True)


def test_a_second_run_is_told_who_runs_since_when(tmp_path: Path) -> None:
    with subprocess.Popen([sys.executable, "-c", TAKE, str(tmp_path)], stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "taken\n"
        with pytest.raises(ConfigError, match=f"another run of softkin goes on here, process {other.pid} since 20"):
            OneRun.of(tmp_path).take(patience=0.1)
        other.kill()
    assert OneRun.of(tmp_path).take(patience=5) == []


def test_what_a_killed_run_left_is_cleared_and_named(tmp_path: Path) -> None:
    (tmp_path / ".snakemake" / "locks").mkdir(parents=True)
    (tmp_path / ".snakemake" / "locks" / "0.output.lock").write_text("results/report.html")
    (tmp_path / "results" / "finger").mkdir(parents=True)
    (tmp_path / "results" / "finger" / ".table.parquet.99.part").write_text("half")
    (tmp_path / "results" / "finger" / "table.parquet").write_text("whole")
    job = started_job(tmp_path)
    deadline = time.monotonic() + 20
    while not psutil.Process(job.pid).children():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    child = psutil.Process(job.pid).children()[0]
    assert [process.pid for process in orphans_of(tmp_path)] == [job.pid]
    assert clear(tmp_path) == [
        "ended 1 jobs that a killed run had left running",
        "removed the lock of a killed run",
        "removed 1 half-written files",
    ]
    job.wait(5)
    assert not psutil.pid_exists(job.pid)
    assert not child.is_running() or child.status() == psutil.STATUS_ZOMBIE
    assert [path.name for path in (tmp_path / "results" / "finger").iterdir()] == ["table.parquet"]
    assert clear(tmp_path) == []


def test_jobs_of_other_folders_and_of_a_living_snakemake_go_on(tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "there").mkdir()
    job = started_job(tmp_path / "there")
    try:
        assert orphans_of(tmp_path / "here") == []
    finally:
        end([psutil.Process(job.pid)])
        job.wait()


def test_a_process_that_does_not_listen_is_ended_by_force() -> None:
    deaf = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print(1, flush=True); time.sleep(60)"
    with subprocess.Popen([sys.executable, "-c", deaf], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        end([psutil.Process(process.pid)], grace=0.2)
        process.wait(5)
        assert not psutil.pid_exists(process.pid)


@pytest.mark.parametrize(
    ("arguments", "looks"),
    [
        (["--cores", "2"], False),
        (["--dry-run"], True),
        (["-n"], True),
        (["--report", "page.html"], True),
        (["--report=page.html"], True),
        (["--config", "seed=1"], False),
        (["results/report.html"], False),
        (["--unlock"], False),  # which nobody may do to another run
    ],
)
def test_looking_needs_no_lock(arguments: list[str], looks: bool) -> None:
    assert only_looks(arguments) is looks


def test_the_lock_is_no_business_of_children(tmp_path: Path) -> None:
    """A job that outlives its run does not keep the lock."""
    take = TAKE.replace("time.sleep(60)", "import subprocess; subprocess.Popen(['sleep', '5']); sys.exit()")
    done = subprocess.run([sys.executable, "-c", take, str(tmp_path)], capture_output=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    assert OneRun.of(tmp_path).take(patience=0.1) == []


@pytest.mark.parametrize("note", ['{"pid": 7, "since": "2999-01-01T00:00:00+00:00"}', '{"pid": 7, "si', ""])
def test_what_a_killed_run_noted_of_itself_holds_nobody_up(tmp_path: Path, note: str) -> None:
    """Neither a torn note, nor one of a clock that ran ahead."""
    (tmp_path / ".snakemake").mkdir()
    (tmp_path / ".snakemake" / "softkin_run.json").write_text(note)
    (tmp_path / ".snakemake" / "softkin.lock").touch()
    os.utime(tmp_path / ".snakemake" / "softkin.lock", (2**33, 2**33))
    assert OneRun.of(tmp_path).take(patience=0.1) == []
