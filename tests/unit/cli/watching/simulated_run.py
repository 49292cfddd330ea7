"""A made-up run: its jobs, what they take on some machine, and when each starts and ends."""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from random import Random

from softkin.cli.watching.job import Job

#: Largest first, as Snakemake goes.
DATASETS = {"larger": 2.0, "large": 1.5, "middle": 1.0, "small": 0.5}
MODELS = {f"model{place}": seconds for place, seconds in enumerate((30.0, 4.0, 15.0, 6.0, 60.0, 5.0, 20.0, 8.0))}
#: (rule, seconds on the middle dataset) of the jobs after the models of a dataset, each waiting for the one before.
AFTER = (("refit", 40.0), ("calibrate", 20.0), ("score", 20.0), ("draw", 25.0), ("track", 12.0))
AT_THE_END = (("tables", 5.0), ("report", 10.0))


def jobs_of_a_run() -> dict[int, Job]:
    """Jobs of four datasets, about 23 minutes of work on one core; the later its stage, the higher is its priority."""
    jobs: dict[int, Job] = {}

    def add(rule: str, seconds: float, needs: list[int], priority: float, **wildcards: str) -> int:
        jobs[len(jobs)] = Job(rule, wildcards, seconds, needs=needs, priority=priority)
        return len(jobs) - 1

    ends = []
    for dataset, size in DATASETS.items():
        first = add("prepare", 3.0, [add("retrieve", 1.0, [], 50.0, dataset=dataset)], 40.0, dataset=dataset)
        last = [add("tune", size * s, [first], 0.0, dataset=dataset, model=model) for model, s in MODELS.items()]
        for place, (rule, seconds) in enumerate(AFTER, start=1):
            last = [add(rule, size * seconds, last, 5.0 * place, dataset=dataset)]
        ends += last
    for rule, seconds in AT_THE_END:
        ends = [add(rule, seconds, ends, 0.0)]
    return jobs


def takes(jobs: Mapping[int, Job], factor: float, noise: float, seed: int) -> dict[int, float]:
    """Seconds of each job on a machine that takes `factor` times as long, give or take `noise` (of the logarithm)."""
    random = Random(seed)
    return {number: job.shipped * factor * math.exp(random.gauss(0.0, noise)) for number, job in jobs.items()}


def scheduled(jobs: Mapping[int, Job], seconds: Mapping[int, float], cores: int) -> dict[int, Job]:
    """The jobs with their starts and ends: one starts as soon as a core is free, by priority, then number."""
    done: dict[int, Job] = {}
    running: list[tuple[float, int]] = []
    now = 0.0
    while len(done) < len(jobs):
        ended = {number for number, job in done.items() if job.ended is not None and job.ended <= now}
        ready = [number for number, job in jobs.items() if number not in done and set(job.needs) <= ended]
        ready.sort(key=lambda number: (-jobs[number].priority, number))
        for number in ready[: cores - len(running)]:
            done[number] = replace(jobs[number], started=now, ended=now + seconds[number])
            heapq.heappush(running, (now + seconds[number], number))
        now = heapq.heappop(running)[0]
    return done


def seen_at(run: Mapping[int, Job], now: float) -> dict[int, Job]:
    """The jobs as they are known at a time of the run."""

    def known(time: float | None) -> float | None:
        return time if time is not None and time <= now else None

    return {number: replace(job, started=known(job.started), ended=known(job.ended)) for number, job in run.items()}


def moments(run: Mapping[int, Job], first_share: float, count: int = 40) -> Iterator[tuple[float, float]]:
    """(time, seconds left) at times of the run from a share of it on, evenly spread."""
    whole = max(job.ended or 0.0 for job in run.values())
    for place in range(count):
        now = whole * (first_share + (1.0 - first_share) * place / count)
        yield now, whole - now
