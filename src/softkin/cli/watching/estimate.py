"""Estimate the time that is left of a run: what jobs are expected to take, at the pace of this machine."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from heapq import heapify, heappop, heappush

from softkin.cli.watching.job import Job
from softkin.cli.watching.study_log import study_seconds_left

#: Seconds of jobs at a pace of 1 that count with those that were measured, so that few jobs do not set the pace.
PRIOR_SECONDS = 20.0
#: A job counts in the pace of all as at most this many times what was expected: one that hangs sets that of its rule.
MOST = 4.0
#: A job that takes longer than expected needs this share of its time so far once more.
OVERDUE_SHARE = 0.1


@dataclass(frozen=True, slots=True)
class Remaining:
    """Estimated seconds until the end. `is_rough`: this machine has not shown yet how fast it is."""

    seconds: float
    is_rough: bool = False


class _Pace:
    """Seconds of this run per expected second: above 1 on a slower or busier machine, or when studies are longer.

    Each rule has its own, drawn towards that of all jobs, which is drawn towards 1.
    """

    def __init__(self) -> None:
        self.measured: dict[str, float] = defaultdict(float)
        self.expected: dict[str, float] = defaultdict(float)

    def add(self, rule: str, measured: float, expected: float) -> None:
        """Count a job."""
        for name, seconds in ((rule, measured), ("", min(measured, MOST * expected))):
            self.measured[name] += seconds
            self.expected[name] += expected

    def of(self, rule: str) -> float:
        """The pace of a rule."""
        of_all = (self.measured[""] + PRIOR_SECONDS) / (self.expected[""] + PRIOR_SECONDS)
        return (self.measured[rule] + PRIOR_SECONDS * of_all) / (self.expected[rule] + PRIOR_SECONDS)


def remaining(jobs: Mapping[int, Job], cores: int, now: float) -> Remaining:
    """The time that the jobs which have not ended will take.

    A job is expected to take what it took in the run before, or else what the shipped timings say, at the pace of this
    run; the two kinds have paces of their own. One that is overdue takes at least until its study ends. Jobs wait for
    those whose files they read, and for a core.

    Parameters:
        jobs: by number; `needs` are numbers of others.
        cores: how many jobs run at a time.
        now: seconds, the clock of the jobs.
    """
    own, shipped = _Pace(), _Pace()
    for job in jobs.values():
        if job.taken is not None:
            _count(job, job.taken, own, shipped)
    overdue = {}
    for number, job in jobs.items():
        elapsed = job.elapsed(now)
        if elapsed is not None and elapsed > _whole(job, own, shipped):
            overdue[number] = max(OVERDUE_SHARE * elapsed, study_seconds_left(job.log))
            _count(job, elapsed + overdue[number], own, shipped)
    blocked = _waiting_for_failed(jobs)
    left = {
        number: max(0.0, overdue.get(number, _whole(job, own, shipped) - (job.elapsed(now) or 0.0)))
        for number, job in jobs.items()
        if job.ended is None and number not in blocked
    }
    seen = min(shipped.measured[""], shipped.expected[""])
    is_rough = seen < PRIOR_SECONDS and any(jobs[number].earlier is None for number in left)
    return Remaining(_until_the_last(jobs, left, cores), is_rough)


def _count(job: Job, measured: float, own: _Pace, shipped: _Pace) -> None:
    shipped.add(job.rule, measured, job.shipped)
    if job.earlier is not None:
        own.add(job.rule, measured, job.earlier)


def _whole(job: Job, own: _Pace, shipped: _Pace) -> float:
    """Seconds that a job is expected to take from its start to its end."""
    return job.shipped * shipped.of(job.rule) if job.earlier is None else job.earlier * own.of(job.rule)


def _waiting_for_failed(jobs: Mapping[int, Job]) -> set[int]:
    """The jobs that will not start, since one that they wait for, directly or not, has failed."""

    @cache
    def waits(number: int) -> bool:
        return any(jobs[needed].failed or waits(needed) for needed in jobs[number].needs)

    return {number for number in jobs if waits(number)}


def _until_the_last(jobs: Mapping[int, Job], left: Mapping[int, float], cores: int) -> float:
    """Seconds until the last job ends when each starts as soon as it waits for none and a core is free: the highest
    priority first, then the longest.
    """
    waits = {number: sum(needed in left for needed in jobs[number].needs) for number in left}
    waiting: dict[int, list[int]] = defaultdict(list)
    for number in left:
        for needed in jobs[number].needs:
            waiting[needed].append(number)
    running = [(left[number], number) for number in left if jobs[number].started is not None]
    ready = [_rank(jobs, left, number) for number in left if jobs[number].started is None and not waits[number]]
    heapify(running)
    heapify(ready)
    end = 0.0
    while running or ready:
        while ready and len(running) < cores:
            number = heappop(ready)[-1]
            heappush(running, (end + left[number], number))
        end, ended = heappop(running)
        for number in waiting[ended]:
            waits[number] -= 1
            if not waits[number]:
                heappush(ready, _rank(jobs, left, number))
    return end


def _rank(jobs: Mapping[int, Job], left: Mapping[int, float], number: int) -> tuple[float, float, int]:
    """Sorts jobs that can start in the order in which they do."""
    return -jobs[number].priority, -left[number], number
