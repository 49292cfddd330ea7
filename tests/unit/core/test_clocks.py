from __future__ import annotations

import time
from pathlib import Path

import pytest

from softkin.core.clocks import counted_as_fit, stopwatch, used, used_by_log
from softkin.core.job import job


def work(seconds: float) -> None:
    end = time.process_time() + seconds
    while time.process_time() < end:
        sum(range(1000))


def test_a_fit_within_a_fit_counts_once() -> None:
    before = used()
    work(0.05)
    with counted_as_fit():
        work(0.05)
        with counted_as_fit():
            work(0.05)
    after = used()
    assert after.fit_seconds - before.fit_seconds == pytest.approx(0.1, abs=0.03)
    assert after.cpu_seconds - before.cpu_seconds >= 0.14
    assert after.memory_mb > 10


def test_a_job_that_fails_counts_the_fit_that_it_was_in() -> None:
    def fails() -> None:
        with counted_as_fit():
            work(0.02)
            raise ValueError("stop")

    before = used().fit_seconds
    with pytest.raises(ValueError, match="stop"):
        fails()
    assert used().fit_seconds - before >= 0.02


def test_the_last_word_of_a_log_is_what_the_job_used(tmp_path: Path) -> None:
    log = tmp_path / "job.log"
    with job(str(log), "fit"), counted_as_fit():
        work(0.02)
    read = used_by_log(log)
    assert read is not None
    assert str(read) in log.read_text().splitlines()[-1]
    assert read.fit_seconds == pytest.approx(used().fit_seconds, abs=0.02)


def test_a_job_that_has_not_ended_used_nothing_yet(tmp_path: Path) -> None:
    log = tmp_path / "job.log"
    log.write_text("12:00 INFO trial 1 of 2\n")
    assert used_by_log(log) is None


def test_the_stopwatch_tells_waiting_from_working() -> None:
    with stopwatch() as watch:
        time.sleep(0.05)
    assert watch.seconds >= 0.05
    assert watch.cpu_seconds < 0.05
