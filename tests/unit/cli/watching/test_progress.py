from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli.watching.progress import Job, Progress, Remaining, in_order, measured_seconds, trials


def progress(*jobs: Job, cores: int = 1) -> Progress:
    return Progress(dict(enumerate(jobs)), cores, start=0.0)


def test_nothing_known_is_no_estimate() -> None:
    assert progress(Job("tune", {}), Job("fit_tuned", {})).remaining(5.0) == Remaining(None)


def test_the_run_before_gives_the_estimate() -> None:
    run = progress(Job("tune", {}, earlier=30.0), Job("tune", {}, earlier=10.0))
    assert run.remaining(0.0) == Remaining(40.0)
    run.begin(0, 0.0)
    assert run.remaining(12.0) == Remaining(28.0)
    run.end(0, 30.0)
    assert run.remaining(30.0) == Remaining(10.0)


def test_cores_share_the_work_but_not_one_job() -> None:
    jobs = [Job("tune", {}, earlier=seconds) for seconds in (10.0, 10.0, 20.0)]
    assert progress(*jobs, cores=2).remaining(0.0) == Remaining(20.0)
    assert progress(*jobs, cores=4).remaining(0.0) == Remaining(20.0)
    assert progress(*jobs[:2], cores=2).remaining(0.0) == Remaining(10.0)


def test_a_job_that_takes_longer_than_before_has_no_time_left() -> None:
    run = progress(Job("tune", {}, earlier=30.0), Job("fit", {}, earlier=5.0))
    run.begin(0, 0.0)
    assert run.remaining(100.0) == Remaining(5.0)


def test_without_an_earlier_run_a_rule_takes_what_it_has_taken() -> None:
    run = progress(*(Job("predict", {}) for _ in range(4)), Job("report", {}))
    for number, seconds in enumerate((2.0, 4.0)):
        run.begin(number, 10.0)
        run.end(number, 10.0 + seconds)
    assert run.remaining(20.0) == Remaining(6.0, is_rough=True)  # two predictions of 3 s; the report is unknown


def test_most_jobs_unknown_is_no_estimate() -> None:
    run = progress(Job("fit_paper", {}, earlier=60.0), Job("tune", {}), Job("report", {}))
    assert run.remaining(0.0) == Remaining(None)


def test_a_study_is_projected_from_its_trials(tmp_path: Path) -> None:
    log = tmp_path / "tune.log"
    log.write_text("2026-01-01 00:00:00,000 INFO resuming after 2 of 8 trials\n")
    run = progress(Job("tune", {}, log=log, earlier=1000.0))
    run.begin(0, 0.0)
    assert run.remaining(10.0) == Remaining(30.0)
    log.write_text("2026-01-01 00:00:00,000 DEBUG trial 4 of 8: COMPLETE 1.2 {}\n" * 500)
    assert trials(log) == (4, 8)
    assert run.remaining(10.0) == Remaining(10.0)


@pytest.mark.parametrize("text", ["", "2026-01-01 INFO fitted on 120 rows in 0.2 s\n"])
def test_a_log_without_trials_has_none(tmp_path: Path, text: str) -> None:
    (tmp_path / "fit.log").write_text(text)
    assert trials(tmp_path / "fit.log") is None
    assert trials(tmp_path / "missing.log") is None


def test_late_in_a_run_the_last_jobs_are_estimated_though_never_timed() -> None:
    run = progress(*(Job("predict", {}) for _ in range(18)), Job("report", {}), Job("track", {}))
    for number in range(18):
        run.begin(number, 0.0)
        run.end(number, 3.0)
    assert run.remaining(54.0) == Remaining(6.0)


def test_a_busier_machine_stretches_what_is_left() -> None:
    run = progress(*(Job("fit", {}, earlier=10.0) for _ in range(5)))
    for number in range(3):
        run.begin(number, 0.0)
        run.end(number, 20.0)
    assert run.pace() == 2.0
    assert run.remaining(60.0) == Remaining(40.0)


def test_a_failed_job_is_neither_done_nor_a_measure() -> None:
    run = progress(Job("fit", {}), Job("fit", {}))
    run.begin(0, 0.0)
    run.end(0, 1.0, failed=True)
    assert (run.done, run.failed) == (0, 1)
    assert run.remaining(1.0) == Remaining(None)
    run.begin(0, 2.0)  # restarted
    assert run.failed == 0


def test_a_job_that_does_no_work_is_not_counted() -> None:
    run = progress(Job("fit", {}))
    run.begin(99, 0.0)
    assert run.end(99, 1.0) is None


def test_measured_seconds_reads_the_last_row(tmp_path: Path) -> None:
    file = tmp_path / "gp.tsv"
    file.write_text("s\th:m:s\tcpu_time\n3.5\t0:00:03\t-\n4.25\t0:00:04\t1.0\n")
    assert measured_seconds(file) == 4.25
    assert measured_seconds(tmp_path / "none.tsv") is None
    assert measured_seconds(None) is None


def test_jobs_stand_in_the_order_of_their_rules() -> None:
    jobs = {1: Job("tune", {}), 2: Job("prepare", {}), 3: Job("tune", {})}
    assert list(in_order(jobs, ["prepare", "tune"])) == [2, 1, 3]
