"""The view gets Snakemake's events, on a made-up stream: a terminal or none."""

from __future__ import annotations

import io
import logging
import os
import pty
import re
import select
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import TextIO

import pytest

from softkin.cli.watching.job import Job
from softkin.cli.watching.progress import Progress
from softkin.cli.watching.view import View
from softkin.core.terminal import ON_A_SCREEN

CLOCK = r"[0-2]\d:[0-5]\d:[0-5]\d"


@pytest.fixture
def logger() -> Iterator[logging.Logger]:
    logger = logging.getLogger("snakemake of a test")
    logger.setLevel(logging.INFO)
    logger.propagate = False
    yield logger
    logger.handlers = []


def jobs(log: Path | None = None) -> Progress:
    return Progress({1: Job("prepare", {"dataset": "finger"}, log=log), 2: Job("tune", {"dataset": "finger"})}, 2, 0.0)


def watching(logger: logging.Logger, stream: io.StringIO) -> View:
    """A view that has started, and whose clock ticks a second at each look."""
    own: logging.StreamHandler[TextIO] = logging.StreamHandler(stream)
    logger.addHandler(own)
    ticks = iter(range(100))
    view = View(jobs(), own, "softkin test", clock=lambda: float(next(ticks)))
    view.start(logger)
    return view


def run_of(logger: logging.Logger) -> None:
    """Snakemake's messages of a run in which one job ends and another fails."""
    logger.info("Select jobs to execute...")
    logger.info("Execute 1 jobs...", extra={"event": "job_started", "jobs": [1]})
    logger.info(" Rule: prepare", extra={"event": "job_info", "jobid": 1})
    logger.info("Finished", extra={"event": "job_finished", "job_id": 1})
    logger.info("Execute 1 jobs...", extra={"event": "job_started", "jobs": [2]})
    logger.error("Error in rule tune", extra={"event": "job_error", "jobid": 2})


def written_to(master: int) -> str:
    """All that a pseudo-terminal was sent."""
    written = b""
    while select.select([master], [], [], 0.5)[0]:
        written += os.read(master, 65536)
    return written.decode()


def test_a_log_file_gets_plain_lines(logger: logging.Logger) -> None:
    stream = io.StringIO()
    view = watching(logger, stream)
    run_of(logger)
    view.finish(logger)
    logger.info("Complete log: x")
    lines = stream.getvalue().splitlines()
    assert re.fullmatch(rf"\[{CLOCK} · 1 of 2 jobs · .* left\] prepare finger: 2.0 s", lines[0])
    assert re.fullmatch(rf"\[{CLOCK} · 1 of 2 jobs · 1 FAILED · .* left\] tune finger: FAILED", lines[1])
    assert lines[2] == "Error in rule tune"
    assert re.match(rf"{CLOCK} softkin test: 1 of 2 jobs in ", lines[3])
    assert lines[3].endswith("1 failed")
    assert lines[4:] == ["Complete log: x"]
    assert "\033" not in stream.getvalue()
    assert ON_A_SCREEN not in os.environ


def test_jobs_of_a_group_count_from_the_start_of_the_group(logger: logging.Logger) -> None:
    """An executor tells the start of a group by a name of its own, and the end of each of its jobs."""
    stream = io.StringIO()
    view = watching(logger, stream)
    logger.info("Execute 1 jobs...", extra={"event": "job_started", "jobs": ["5d1c"]})
    group = [SimpleNamespace(jobid=1), SimpleNamespace(jobid=2)]
    logger.info("Group job", extra={"event": "group_info", "group_id": "5d1c", "jobs": group})
    for number in (1, 2):
        logger.info("Finished", extra={"event": "job_finished", "job_id": number})
    view.finish(logger)
    lines = stream.getvalue().splitlines()
    assert re.fullmatch(rf"\[{CLOCK} · 1 of 2 jobs · .* left\] prepare finger: \d.\d s", lines[0])
    assert re.fullmatch(rf"\[{CLOCK} · 2 of 2 jobs · .* left\] tune finger: \d.\d s", lines[1])
    assert re.match(rf"{CLOCK} softkin test: 2 of 2 jobs in ", lines[2])


def test_a_terminal_gets_one_screen_and_the_warnings_of_jobs(
    logger: logging.Logger, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TERM", "xterm")
    log = tmp_path / "prepare.log"
    log.write_text(
        "2026-01-01 00:00:00,000 INFO read\n"
        "2026-01-01 00:00:00,000 WARNING row 7 is far out\n"
        "2026-01-01 00:00:00,000 WARNING x.py:3: UserWarning: of a library\n"
    )
    master, slave = pty.openpty()
    with os.fdopen(slave, "w") as stream:
        own: logging.StreamHandler[TextIO] = logging.StreamHandler(stream)
        logger.addHandler(own)
        view = View(jobs(log), own, "softkin test")
        view.start(logger)
        assert os.environ[ON_A_SCREEN] == "1"
        run_of(logger)
        view.finish(logger)
        shown = written_to(master)
    os.close(master)
    assert ON_A_SCREEN not in os.environ
    assert "0 of 2 jobs" in shown
    assert "\033[J" in shown
    assert "prepare finger: row 7 is far out" in shown
    assert "of a library" not in shown
    assert "Error in rule tune" in shown
    assert "Select jobs" not in shown
    last = shown.split("\033[J")[-1]
    assert last.startswith("softkin test: 1 of 2 jobs in ")
    assert own in logger.handlers
    assert view not in logger.handlers


def test_a_dumb_terminal_gets_plain_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "dumb")
    master, slave = pty.openpty()
    with os.fdopen(slave, "w") as stream:
        assert not View(jobs(), logging.StreamHandler(stream), "softkin").is_screen
    os.close(master)


class ClosedPipe(io.StringIO):
    """A pipe that nobody reads any more."""

    def flush(self) -> None:
        raise BrokenPipeError


def test_a_closed_pipe_does_not_stop_the_run(logger: logging.Logger) -> None:
    view = View(jobs(), logging.StreamHandler(ClosedPipe()), "softkin test")
    view.start(logger)
    run_of(logger)
    view.finish(logger)
    assert (view.progress.done, view.progress.failed) == (1, 1)
