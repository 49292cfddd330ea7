"""Read off the log of a job how far its study is."""

from __future__ import annotations

import re
from datetime import datetime
from pathlib import Path

#: What `softkin.training.study` writes into its log, once a trial.
TRIALS = re.compile(r"^(\S+ \S+) \S+ (?:trial|resuming after) (\d+) of (\d+)\b", re.MULTILINE)
#: The last trials stand in the last lines of a log.
TAIL_BYTES = 8000
TIME = "%Y-%m-%d %H:%M:%S,%f"


def trials(log: Path | None) -> tuple[int, int] | None:
    """(trials done, trials in all) by the log of a study; None for another job, and before the first trial ends."""
    lines = _lines(log)
    return lines[-1][1:] if lines else None


def study_seconds_left(log: Path | None) -> float:
    """Seconds that the trials to come will take at the pace of the last ones; 0 where nothing is known of that.

    A job may hold several studies: of those after this one nothing is known.
    """
    lines = _lines(log)
    if not lines:
        return 0.0
    end, done, total = lines[-1]
    start, before = end, done
    for time, count, of in reversed(lines):
        if of != total or count > before:
            break
        start, before = time, count
    if before == done:
        return 0.0
    seconds = (datetime.strptime(end, TIME) - datetime.strptime(start, TIME)).total_seconds()
    return seconds / (done - before) * (total - done)


def _lines(log: Path | None) -> list[tuple[str, int, int]]:
    """(time, trials done, trials in all) of each trial in the tail of a log."""
    if log is None or not log.is_file():
        return []
    with log.open("rb") as file:
        file.seek(max(0, log.stat().st_size - TAIL_BYTES))
        found = TRIALS.findall(file.read().decode("utf-8", errors="replace"))
    return [(time, int(done), int(total)) for time, done, total in found]
