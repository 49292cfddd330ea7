from __future__ import annotations

from softkin.cli.watching.estimate import Remaining
from softkin.cli.watching.job import Job
from softkin.cli.watching.progress import Progress


def progress(*jobs: Job, cores: int = 1) -> Progress:
    return Progress(dict(enumerate(jobs)), cores, start=0.0)


def test_a_failed_job_is_not_done_until_it_ends_well() -> None:
    run = progress(Job("fit", {}), Job("fit", {}))
    run.begin(0, 0.0)
    run.end(0, 1.0, failed=True)
    assert (run.done, run.failed) == (0, 1)
    run.begin(0, 2.0)  # restarted
    assert run.failed == 0
    run.end(0, 3.0)
    assert (run.done, run.failed) == (1, 0)


def test_a_job_that_does_no_work_is_not_counted() -> None:
    run = progress(Job("fit", {}))
    run.begin(99, 0.0)
    assert run.end(99, 1.0) is None


def test_running_jobs_stand_in_the_order_of_their_start() -> None:
    run = progress(Job("fit", {}), Job("tune", {}), Job("score", {}))
    run.begin(1, 1.0)
    run.begin(0, 2.0)
    assert [job.rule for job in run.running] == ["tune", "fit"]


def test_stages_count_their_jobs() -> None:
    run = progress(Job("tune", {}), Job("tune", {}), Job("score", {}))
    run.begin(0, 0.0)
    run.end(0, 1.0)
    assert run.stages() == [("tune", 1, 2), ("score", 0, 1)]


def test_the_time_left_is_estimated_on_its_cores() -> None:
    run = progress(Job("tune", {}, 30.0), Job("tune", {}, 10.0), cores=2)
    run.begin(0, 0.0)
    run.begin(1, 0.0)
    assert run.remaining(5.0) == Remaining(25.0, is_rough=True)
