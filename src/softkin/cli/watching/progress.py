"""Count the jobs of a run and estimate the time that is left; nothing is drawn here."""

from __future__ import annotations

import csv
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

#: What `softkin.training.study` writes into its log, once a trial.
TRIALS = re.compile(r"\b(?:trial|resuming after) (\d+) of (\d+)\b")
#: The last trial stands in the last few lines of a log.
TAIL_BYTES = 8000
#: Fewest jobs, and seconds of the run before, from which the pace of this run is computed.
PACE_JOBS, PACE_SECONDS = 3, 10.0
#: From this share of ended jobs on, the few that were never timed do not make an estimate rough.
LATE = 0.9


@dataclass(slots=True)
class Job:
    """A job of the run.

    Attributes:
        rule: its rule.
        wildcards: its wildcards, in order.
        log: its log file.
        earlier: what it took in the run before, in seconds; None where not known.
        started: when it started, in seconds of any one clock; None: not yet.
        ended: when it ended, likewise.
        failed: whether it ended in an error.
    """

    rule: str
    wildcards: Mapping[str, str]
    log: Path | None = None
    earlier: float | None = None
    started: float | None = None
    ended: float | None = None
    failed: bool = False

    @property
    def stage(self) -> str:
        """Its rule in words: 'fit tuned'."""
        return self.rule.replace("_", " ")

    @property
    def name(self) -> str:
        """Its rule and wildcards in words: 'fit tuned finger gp'."""
        return " ".join([self.stage, *self.wildcards.values()])

    @property
    def taken(self) -> float | None:
        """Seconds that it took; None unless it has ended well."""
        return None if self.started is None or self.ended is None or self.failed else self.ended - self.started


@dataclass(frozen=True, slots=True)
class Remaining:
    """Estimated seconds until the end; None when most of it is unknown. `is_rough`: some jobs were never timed, and are
    counted as others of their rule, which may have another model or dataset, or not at all.
    """

    seconds: float | None
    is_rough: bool = False


def trials(log: Path | None) -> tuple[int, int] | None:
    """(trials done, trials in all) by the log of a study; None for another job, and before the first trial ends."""
    if log is None or not log.is_file():
        return None
    with log.open("rb") as file:
        file.seek(max(0, log.stat().st_size - TAIL_BYTES))
        counts = TRIALS.findall(file.read().decode("utf-8", errors="replace"))
    return (int(counts[-1][0]), int(counts[-1][1])) if counts else None


def measured_seconds(benchmark: str | Path | None) -> float | None:
    """Wall seconds in a benchmark file of Snakemake's; None when there is none."""
    if benchmark is None or not Path(benchmark).is_file():
        return None
    with Path(benchmark).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    return float(rows[-1]["s"]) if rows else None


class Progress:
    """A run: `jobs` by Snakemake's number, on `cores` cores, started at `start` (seconds, the clock of all times)."""

    def __init__(self, jobs: Mapping[int, Job], cores: int, start: float) -> None:
        self.jobs, self.cores, self.start = dict(jobs), cores, start

    @property
    def running(self) -> list[Job]:
        """The jobs that run, in the order of their start."""
        jobs = [job for job in self.jobs.values() if job.started is not None and job.ended is None]
        return sorted(jobs, key=lambda job: job.started or 0.0)

    @property
    def done(self) -> int:
        """How many jobs have ended well."""
        return sum(job.taken is not None for job in self.jobs.values())

    @property
    def failed(self) -> int:
        """How many jobs have failed."""
        return sum(job.failed for job in self.jobs.values())

    def begin(self, number: int, now: float) -> None:
        """Note that a job has started, or starts again."""
        job = self.jobs.get(number)
        if job:
            job.started, job.ended, job.failed = now, None, False

    def end(self, number: int, now: float, *, failed: bool = False) -> Job | None:
        """Note that a job has ended, and return it; None for one that does no work, such as `all`."""
        job = self.jobs.get(number)
        if job:
            job.ended, job.failed = now, failed
        return job

    def stages(self) -> list[tuple[str, int, int]]:
        """(stage, jobs done, jobs in all), in the order in which the rules were given."""
        counts: dict[str, list[int]] = defaultdict(lambda: [0, 0])
        for job in self.jobs.values():
            counts[job.stage][0] += job.taken is not None
            counts[job.stage][1] += 1
        return [(stage, done, total) for stage, (done, total) in counts.items()]

    def pace(self) -> float:
        """Seconds of this run per second of the earlier one: above 1 on a slower or busier machine."""
        both = [(job.taken, job.earlier) for job in self.jobs.values() if job.taken is not None and job.earlier]
        earlier = sum(then for _, then in both)
        return sum(now for now, _ in both) / earlier if len(both) >= PACE_JOBS and earlier >= PACE_SECONDS else 1.0

    def remaining(self, now: float) -> Remaining:
        """The time that the jobs which have not ended will take, shared among the cores.

        A study that has ended k of n trials takes n/k of its time so far; any other job what it took in the run
        before, at the pace of this one; a job without that the median of its rule, and late in a run that of all jobs.
        """
        pace = self.pace()
        whole = {id(job): self._whole(job, now, pace) for job in self.jobs.values()}
        by_rule: dict[str, list[float]] = defaultdict(list)
        for job in self.jobs.values():
            known = whole[id(job)]
            if known is not None and not job.failed:
                by_rule[job.rule].append(known)
        left, uncounted, is_rough = [], 0, False
        for job in self.jobs.values():
            if job.ended is not None:
                continue
            seconds = whole[id(job)]
            if seconds is None:
                is_rough = True
                seconds = median(by_rule[job.rule]) if by_rule[job.rule] else None
            if seconds is None:
                uncounted += 1
            else:
                left.append(max(0.0, seconds - (now - job.started if job.started is not None else 0.0)))
        taken = [job.taken for job in self.jobs.values() if job.taken is not None]
        if len(taken) >= LATE * len(self.jobs):
            left, is_rough = [*left, *[median(taken)] * uncounted], False
        elif uncounted > len(left):
            return Remaining(None)
        return Remaining(max(sum(left) / self.cores, max(left, default=0.0)), is_rough)

    @staticmethod
    def _whole(job: Job, now: float, pace: float) -> float | None:
        """Seconds of a job from its start to its end, known or estimated from the job itself."""
        if job.taken is not None:
            return job.taken
        study = trials(job.log) if job.started is not None and job.ended is None else None
        if study and study[0] and job.started is not None:
            return (now - job.started) * study[1] / study[0]
        return None if job.earlier is None else job.earlier * pace


def in_order(jobs: Mapping[int, Job], rules: Sequence[str]) -> dict[int, Job]:
    """The jobs in the order of their rules."""
    return dict(sorted(jobs.items(), key=lambda item: (rules.index(item[1].rule), item[0])))
