"""The view of a run: one screen on a terminal, plain lines in a pipe. Most tests have a run of their own."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import subprocess
import termios
from pathlib import Path

import psutil
import pytest

from tests.workflow.conftest import House, copy_house, processes

pytestmark = pytest.mark.timeout(600)
#: One preset, whose trials are seen in the log; on a terminal all presets run, so that a redraw falls into a study.
TARGET = ("results/finger/gb/tuned/fit.json", "--config", "presets=[tuned]")


@pytest.fixture
def new_house(tmp_path: Path, mirror: Path) -> House:
    copy_house(tmp_path / "house")
    (tmp_path / "work").mkdir()
    return House(tmp_path / "house", tmp_path / "work", mirror)


def on_a_terminal(house: House, *options: str) -> str:
    """All that a run writes to a pseudo-terminal of 100 columns."""
    master, slave = pty.openpty()
    environment = house.environment() | {"TERM": "xterm"}
    run = subprocess.Popen(
        house.command(*options), env=environment, cwd=house.root, stdin=slave, stdout=slave, stderr=slave
    )
    os.close(slave)
    written = b""
    try:
        while part := os.read(master, 65536):
            written += part
    except OSError:  # Linux, once the other end is closed
        pass
    os.close(master)
    assert run.wait() == 0, written.decode()[-3000:]
    return written.decode().replace("\r\n", "\n")


def test_a_terminal_shows_one_quiet_screen(new_house: House) -> None:
    shown = on_a_terminal(new_house, TARGET[0])
    assert re.search("softkin test · 0 of 3 jobs · 0 s used · (roughly .+|under a minute) left", shown)
    assert "\033[J" in shown
    running = [line for line in shown.splitlines() if line.startswith("  fit model  finger  gb")]
    assert any("trial" in line and "of 4" in line for line in running)
    assert "localrule" not in shown
    assert "Finished jobid" not in shown
    assert "fit finger gb: 4 of 4 trials" not in shown  # a job writes to its log alone
    assert "4 of 4 trials" in (new_house.work / "results" / "logs" / "fit_model" / "finger" / "gb.log").read_text()
    assert shown.split("\033[J")[-1].startswith("softkin test: 3 of 3 jobs in ")


@pytest.fixture(scope="module")
def piped(tmp_path_factory: pytest.TempPathFactory, mirror: Path) -> tuple[House, str]:
    """A house after a run into a pipe, and what that wrote to standard error."""
    folder = tmp_path_factory.mktemp("piped")
    copy_house(folder / "house")
    (folder / "work").mkdir()
    house = House(folder / "house", folder / "work", mirror)
    done = house.snakemake(*TARGET)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "\033" not in done.stdout
    return house, done.stderr


def test_a_pipe_gets_plain_lines(piped: tuple[House, str]) -> None:
    written = piped[1]
    assert "\033" not in written
    lines = [line for line in written.splitlines() if line.startswith("[") and " jobs · " in line]
    assert [line.split("] ")[1].split(":")[0] for line in lines] == [
        *("retrieve finger", "prepare finger", "fit model finger gb")
    ]
    assert "fit finger gb: 4 of 4 trials, best" in written
    assert "localrule" not in written


def test_where_the_terminal_is_closed_the_next_run_finishes_and_has_an_estimate(piped: tuple[House, str]) -> None:
    """The system sends SIGHUP to the run and to its jobs, here in the middle of a fit."""
    house = piped[0]
    predictions = house.work / "results" / "finger" / "gb" / "tuned" / "predictions.parquet"
    before = predictions.read_bytes()
    close_a_terminal(house, *TARGET, "--forcerun", "prepare")
    assert not predictions.exists()
    # On a busy machine a signal takes its time.
    psutil.wait_procs(list(processes(house.work)), timeout=20)
    assert list(processes(house.work)) == []
    benchmark = house.work / "results" / "benchmarks" / "fit_model" / "finger" / "gb.tsv"
    benchmark.write_text("s\th:m:s\n600.0\t0:10:00\n")
    again = house.snakemake(*TARGET, "--forcerun", "prepare")
    assert again.returncode == 0, again.stdout + again.stderr
    assert "removed the lock of a killed run" in again.stderr
    assert predictions.read_bytes() == before
    ended = [line for line in again.stderr.splitlines() if "] prepare finger: " in line]
    assert len(ended) == 1
    assert re.match(r"\[\d\d:\d\d:\d\d · 1 of 2 jobs · ", ended[0])
    minutes = re.search(r" · about (\d+) min left\] ", ended[0])
    assert minutes
    assert 3 <= int(minutes[1]) <= 30  # ten, at the pace of a machine that others use, too


def on_a_terminal_of_its_own() -> None:
    """In the child: its terminal ends it, also where these tests themselves ignore that theirs is closed (nohup)."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


def close_a_terminal(house: House, *options: str) -> None:
    """Run on a terminal that is closed when a fit has begun."""
    master, slave = pty.openpty()
    run = subprocess.Popen(
        house.command(*options), env=house.environment() | {"TERM": "xterm"}, cwd=house.root,
        stdin=slave, stdout=slave, stderr=slave, start_new_session=True,
        preexec_fn=on_a_terminal_of_its_own,
    )  # fmt: skip
    os.close(slave)
    log, written = house.work / "results" / "logs" / "fit_model" / "finger" / "gb.log", b""
    log.unlink()
    while not log.exists():  # looked at often: a fit takes about a second, and a screen is drawn as seldom
        if select.select([master], [], [], 0.01)[0]:
            written += os.read(master, 65536)
    os.close(master)
    assert run.wait(60) == -signal.SIGHUP, written.decode()[-3000:]


def test_a_run_on_an_executor_is_watched_without_cores(new_house: House) -> None:
    environment = new_house.environment()
    environment["PYTHONPATH"] += f"{os.pathsep}{Path(__file__).parent / 'plugins'}"
    command = new_house.command(
        "results/finger/table.parquet", "--executor", "beside", "--seconds-between-status-checks", "1"
    )
    place = command.index("--cores")
    command[place] = "--jobs"
    done = subprocess.run(
        command, env=environment, cwd=new_house.root, capture_output=True, text=True, check=False, timeout=300
    )
    assert done.returncode == 0, done.stdout + done.stderr
    lines = [line for line in done.stderr.splitlines() if line.startswith("[") and " jobs · " in line]
    assert [line.split("] ")[1].split(":")[0] for line in lines] == ["retrieve finger", "prepare finger"]
