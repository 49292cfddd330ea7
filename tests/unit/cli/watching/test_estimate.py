from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from softkin.cli.watching.estimate import PRIOR_SECONDS, Remaining, remaining
from softkin.cli.watching.job import Job
from tests.unit.cli.watching.simulated_run import jobs_of_a_run, moments, scheduled, seen_at, takes

#: Largest errors of an estimate: a share of what is left, or half a minute at the end.
SHARE, SECONDS = 0.25, 30.0


def left(*jobs: Job, cores: int = 1, now: float = 0.0) -> Remaining:
    return remaining(dict(enumerate(jobs)), cores, now)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0, 3.0])
def test_from_a_tenth_of_a_run_on_the_estimate_is_right_within_a_quarter(factor: float, seed: int) -> None:
    jobs = jobs_of_a_run()
    run = scheduled(jobs, takes(jobs, factor, 0.15, seed), cores=2)
    for now, truth in moments(run, 0.1):
        estimate = remaining(seen_at(run, now), 2, now).seconds
        assert abs(estimate - truth) <= max(SHARE * truth, SECONDS), (
            f"{estimate:.0f} s for {truth:.0f} s at {now:.0f} s"
        )


@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0, 3.0])
def test_a_run_before_on_the_same_machine_is_right_from_the_start(factor: float) -> None:
    jobs = jobs_of_a_run()
    seconds = takes(jobs, factor, 0.15, seed=0)
    timed = {number: replace(job, earlier=seconds[number]) for number, job in jobs.items()}
    run = scheduled(timed, takes(jobs, factor, 0.15, seed=0), cores=2)
    for now, truth in moments(run, 0.0):
        estimate = remaining(seen_at(run, now), 2, now)
        assert abs(estimate.seconds - truth) <= max(0.2 * truth, 10.0)
        assert not estimate.is_rough


def test_an_estimate_stands_from_the_start_and_is_rough_until_the_machine_is_known() -> None:
    jobs = jobs_of_a_run()
    assert remaining(jobs, 2, 0.0).is_rough
    run = scheduled(jobs, takes(jobs, 1.0, 0.0, seed=0), cores=2)
    rough = [remaining(seen_at(run, now), 2, now).is_rough for now in range(0, 120, 10)]
    assert rough == sorted(rough, reverse=True)
    assert not rough[6]  # from the second minute on


def test_more_cores_share_the_work_but_not_one_job() -> None:
    jobs = [Job("tune", {}, seconds) for seconds in (10.0, 10.0, 20.0)]
    assert left(*jobs, cores=2).seconds == 20.0
    assert left(*jobs, cores=4).seconds == 20.0
    assert left(*jobs[:2], cores=2).seconds == 10.0


def test_jobs_that_wait_for_each_other_do_not_share_the_time() -> None:
    chain = [Job("fit", {}, 10.0), Job("score", {}, 5.0, needs=[0]), Job("report", {}, 5.0, needs=[1])]
    assert left(*chain, cores=8).seconds == 20.0


def test_the_order_in_which_jobs_start_is_that_of_their_priorities() -> None:
    long_job_last = [Job("tune", {}, 20.0), Job("fit", {}, 10.0, priority=10.0), Job("fit", {}, 10.0, priority=10.0)]
    assert left(*long_job_last, cores=2).seconds == 30.0
    long_job_first = [replace(long_job_last[0], priority=20.0), *long_job_last[1:]]
    assert left(*long_job_first, cores=2).seconds == 20.0


def test_what_a_running_job_has_used_is_not_left() -> None:
    assert left(Job("tune", {}, 30.0, started=0.0), Job("tune", {}, 10.0), now=12.0).seconds == 28.0


def test_a_slower_machine_stretches_what_is_left() -> None:
    ended = [Job("fit", {}, 1000.0, started=0.0, ended=2000.0)]
    assert left(*ended, Job("fit", {}, 10.0)).seconds == pytest.approx(20.0, rel=0.02)
    assert left(*ended, Job("score", {}, 10.0)).seconds == pytest.approx(20.0, rel=0.02)


def test_few_jobs_do_not_set_the_pace() -> None:
    ended = Job("retrieve", {}, 0.5, started=0.0, ended=5.0)
    assert left(ended, Job("fit", {}, 100.0)).seconds < 130.0


def test_a_job_that_hangs_does_not_set_the_pace_of_the_others() -> None:
    hangs = Job("create_store", {}, 4.0, started=0.0)
    assert left(hangs, Job("fit", {}, 100.0), cores=2, now=600.0).seconds < 160.0


def test_a_rule_has_a_pace_of_its_own() -> None:
    """Fewer trials make studies shorter, and figures take what they took."""
    ended = [Job("tune", {}, 300.0, started=0.0, ended=30.0), Job("draw", {}, 300.0, started=0.0, ended=300.0)]
    assert left(*ended, Job("tune", {}, 100.0)).seconds < 20.0
    assert left(*ended, Job("draw", {}, 100.0)).seconds > 90.0


def test_the_run_before_goes_first_and_has_a_pace_of_its_own() -> None:
    ended = [Job("fit", {}, 1000.0, earlier=3000.0, started=0.0, ended=3000.0)]
    assert left(*ended, Job("fit", {}, 10.0, earlier=30.0)).seconds == pytest.approx(30.0)
    assert left(*ended, Job("fit", {}, 10.0)).seconds == pytest.approx(30.0, rel=0.05)


def test_an_overdue_job_needs_a_little_longer_and_slows_the_others_down() -> None:
    overdue = Job("tune", {}, 30.0, started=0.0)
    assert left(overdue, now=300.0).seconds == pytest.approx(30.0)
    assert left(overdue, Job("tune", {}, 30.0), now=300.0).seconds > 100.0


def test_an_overdue_study_needs_the_time_of_its_trials(tmp_path: Path) -> None:
    log = tmp_path / "tune.log"
    lines = [
        f"2026-01-01 00:00:{second:02},000 DEBUG trial {second} of 100: COMPLETE 1.2 {{}}\n" for second in (10, 20)
    ]
    log.write_text("".join(lines))
    assert left(Job("tune", {}, 5.0, log, started=0.0), now=60.0).seconds == pytest.approx(80.0)
    assert left(Job("tune", {}, 90.0, log, started=0.0), now=60.0).seconds == pytest.approx(30.0)


def test_jobs_that_wait_for_a_failed_one_do_not_start() -> None:
    failed = Job("fit", {}, 10.0, started=0.0, ended=1.0, failed=True)
    jobs = [failed, Job("score", {}, 10.0, needs=[0]), Job("report", {}, 10.0, needs=[1]), Job("fit", {}, 7.0)]
    assert left(*jobs, now=1.0).seconds == 7.0


def test_a_finished_run_has_no_time_left() -> None:
    assert left(Job("fit", {}, 2 * PRIOR_SECONDS, started=0.0, ended=40.0), now=40.0) == Remaining(0.0)
