from __future__ import annotations

from softkin.cli.watching.job import Job, in_order


def test_a_job_is_named_by_its_rule_and_wildcards() -> None:
    job = Job("fit_tuned", {"dataset": "finger", "model": "gp"})
    assert job.stage == "fit tuned"
    assert job.name == "fit tuned finger gp"


def test_a_job_has_elapsed_while_it_runs_and_taken_when_it_has_ended_well() -> None:
    job = Job("fit", {})
    assert (job.elapsed(7.0), job.taken) == (None, None)
    job.started = 5.0
    assert (job.elapsed(7.0), job.taken) == (2.0, None)
    job.ended = 8.0
    assert (job.elapsed(9.0), job.taken) == (None, 3.0)
    job.failed = True
    assert job.taken is None


def test_jobs_stand_in_the_order_of_their_rules() -> None:
    jobs = {1: Job("tune", {}), 2: Job("prepare", {}), 3: Job("tune", {})}
    assert list(in_order(jobs, ["prepare", "tune"])) == [2, 1, 3]
