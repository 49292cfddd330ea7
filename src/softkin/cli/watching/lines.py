"""Write the state of a run in words: the lines of the screen, and the one line that a log gets for a job."""

from __future__ import annotations

from softkin.cli.watching.estimate import Remaining
from softkin.cli.watching.job import Job
from softkin.cli.watching.progress import Progress
from softkin.cli.watching.study_log import trials
from softkin.core.durations import readable, roughly

BAR = 30


def time_left(remaining: Remaining) -> str:
    """The estimate in words: 'about 14 min left', 'roughly 3 min left', 'under a minute left'."""
    word = "roughly" if remaining.is_rough else "about"
    return f"{word} {roughly(remaining.seconds)} left".replace(f"{word} under", "under")


def heading(progress: Progress, now: float) -> str:
    """The run in one line: '63 of 197 jobs · 4 min 12 s used · about 14 min left'; how many failed, if any did."""
    failed = f" · {progress.failed} FAILED" if progress.failed else ""
    used = readable(round(now - progress.start)) if now - progress.start >= 60 else f"{now - progress.start:.0f} s"
    left = time_left(progress.remaining(now))
    return f"{progress.done} of {len(progress.jobs)} jobs{failed} · {used} used · {left}"


def screen_lines(progress: Progress, now: float, *, title: str, width: int, height: int) -> list[str]:
    """The screen, at most `height` lines of at most `width` characters: the run, its stages, each job that runs.

    Parameters:
        progress: the run.
        now: seconds, the clock of `progress`.
        title: what the first line starts with.
        width: characters of a line.
        height: lines of the screen.
    """
    filled = BAR * progress.done // max(1, len(progress.jobs))
    lines = [f"{title} · {heading(progress, now)}", f"[{'#' * filled}{'.' * (BAR - filled)}]  {_stages(progress)}"]
    rows = [_running(job, now) for job in progress.running]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines += ["  " + "  ".join(map(str.ljust, row, widths)) for row in rows]
    return [line.rstrip() if len(line) <= width else line[: width - 1] + "…" for line in lines[:height]]


def ended_line(job: Job, progress: Progress, now: float, clock: str) -> str:
    """A job that has ended: '[14:03:12 · 63 of 197 jobs · 4 min 12 s used · about 14 min left] tune finger gp: 12.3 s';
    `clock` is the time of day.
    """
    how = "FAILED" if job.taken is None else readable(job.taken)
    return f"[{clock} · {heading(progress, now)}] {job.name}: {how}"


def _stages(progress: Progress) -> str:
    """The stages that are not done, each with its jobs done and in all."""
    return ", ".join(f"{stage} {done}/{total}" for stage, done, total in progress.stages() if done < total)


def _running(job: Job, now: float) -> list[str]:
    """The columns of a running job: stage; dataset; model and preset; trials done; time used."""
    others = " ".join(value for name, value in job.wildcards.items() if name != "dataset")
    study = trials(job.log)
    trial = f"trial {study[0]} of {study[1]}" if study else ""
    used = readable(now - job.started) if job.started is not None else ""
    return [job.stage, job.wildcards.get("dataset", ""), others, trial, used]
