"""Run Snakemake as a child process that ends with its jobs when a campaign is told to end."""

from __future__ import annotations

import os
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

import psutil

from softkin.core.errors import DataError
from softkin.core.files import read_json, write_json

#: Seconds that Snakemake and its jobs are given to end by themselves.
GRACE = 15.0
#: Written by the workflow when it starts jobs: how many of how many.
JOBS = Path("logs") / "jobs.json"
STUDIES = "studies"


@dataclass(frozen=True, slots=True)
class Ended:
    """How the workflow ended: exit code, name of the signal that a campaign was stopped by ('' for none), CPU seconds
    of all jobs, how many jobs ran, and how many were there already (None: unknown).
    """

    exit_code: int
    signal: str
    cpu_seconds: float
    jobs_run: int
    jobs_reused: int | None


class Stopped(BaseException):
    """A signal that asks the campaign to end: its name. No `except Exception` of a library holds it up."""


def run_workflow(command: Sequence[str], *, directory: Path, results: Path, refit: bool) -> Ended:
    """Run `command` in a session of its own, and wait.

    Parameters:
        command: of Snakemake.
        directory: folder that it works in.
        results: folder of its results.
        refit: put the studies aside, so that all of them start anew; they come back if the workflow fails.
    """
    before = _counted(results)
    _bring_back_studies(results)
    (results / JOBS).unlink(missing_ok=True)
    cpu, stopped = _children_cpu(), ""
    with _studies_aside(results) if refit else nullcontext():
        with subprocess.Popen(command, cwd=directory, start_new_session=True) as process, stoppable():
            try:
                code = process.wait()
            except Stopped as error:
                stopped, code = str(error), _end(process)
        if refit and code == 0:
            shutil.rmtree(_aside(results), ignore_errors=True)
    counted = _counted(results)
    everything = (counted or before or {}).get("all")
    jobs_run = counted["run"] if counted else 0
    if counted is None and before is not None:  # nothing to be done: what is known of the workflow stays known
        write_json(results / JOBS, {"run": 0, "all": before["all"]})
    return Ended(code, stopped, _children_cpu() - cpu, jobs_run, None if everything is None else everything - jobs_run)


def _counted(results: Path) -> dict[str, int] | None:
    """How many jobs a run does of how many; None where nobody wrote it, or was killed while writing."""
    try:
        return dict(read_json(results / JOBS)) or None if (results / JOBS).exists() else None
    except DataError:
        return None


def _end(process: subprocess.Popen[bytes]) -> int:
    """End a process and all that it has started: by a signal, and by force after `GRACE` seconds."""
    os.killpg(process.pid, signal.SIGTERM)
    deadline = time.monotonic() + GRACE
    while _group_lives(process.pid) and time.monotonic() < deadline:
        process.poll()
        time.sleep(0.1)
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    return process.wait() or 1


def _group_lives(group: int) -> bool:
    """Whether a process of the group still runs."""
    for process in psutil.process_iter(["pid", "status"]):
        with suppress(ProcessLookupError):
            if os.getpgid(process.pid) == group and process.info["status"] != psutil.STATUS_ZOMBIE:
                return True
    return False


@contextmanager
def stoppable() -> Iterator[None]:
    """Raise `Stopped` in the block on SIGTERM, SIGINT and SIGHUP."""

    def stop(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        raise Stopped(signal.Signals(number).name)

    numbers = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
    old = {number: signal.signal(number, stop) for number in numbers}
    try:
        yield
    finally:
        for number, handler in old.items():
            signal.signal(number, handler)


@contextmanager
def _studies_aside(results: Path) -> Iterator[None]:
    """Move the studies away; move them back unless the block has removed them."""
    there = (results / STUDIES).exists()
    if there:
        os.replace(results / STUDIES, _aside(results))
    try:
        yield
    finally:
        if _aside(results).exists():
            shutil.rmtree(results / STUDIES, ignore_errors=True)
            os.replace(_aside(results), results / STUDIES)


def _bring_back_studies(results: Path) -> None:
    """Move back the studies that a refit put aside before it was killed, but for those that it has begun anew."""
    aside, studies = _aside(results), results / STUDIES
    for path in sorted(aside.rglob("*")):
        place = studies / path.relative_to(aside)
        if path.is_file() and not place.exists():
            place.parent.mkdir(parents=True, exist_ok=True)
            os.replace(path, place)
    shutil.rmtree(aside, ignore_errors=True)


def _aside(results: Path) -> Path:
    return results / f"{STUDIES}_before_refit"


def _children_cpu() -> float:
    """CPU seconds of all ended children, and of theirs."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
