"""Count the jobs of a run; nothing is drawn here."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from softkin.cli.watching.estimate import Remaining, remaining
from softkin.cli.watching.job import Job


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

    def remaining(self, now: float) -> Remaining:
        """The time that is left."""
        return remaining(self.jobs, self.cores, now)
