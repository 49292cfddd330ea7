"""What a job used, by the system's own clocks: CPU seconds, those of fits among them, and memory."""

from __future__ import annotations

import re
import resource
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple


class Used(NamedTuple):
    """CPU seconds of a job with its children, imports included; CPU seconds of its fits; its largest resident memory in
    MB.
    """

    cpu_seconds: float
    fit_seconds: float
    memory_mb: float

    def __str__(self) -> str:
        return (
            f"used {self.cpu_seconds:.2f} s of CPU, {self.fit_seconds:.2f} s of it in fits, and {self.memory_mb:.0f} MB"
        )


_USED = re.compile(r"used ([\d.]+) s of CPU, ([\d.]+) s of it in fits, and (\d+) MB")
_MB = 2**20 if sys.platform == "darwin" else 2**10


class _Fits:
    """CPU seconds of the fits of this process; a fit within a fit counts once."""

    seconds = 0.0
    depth = 0


@contextmanager
def counted_as_fit() -> Iterator[None]:
    """Count the CPU seconds of a block, all threads of this process, as those of a fit."""
    start = time.process_time()
    _Fits.depth += 1
    try:
        yield
    finally:
        _Fits.depth -= 1
        if not _Fits.depth:
            _Fits.seconds += time.process_time() - start


def used() -> Used:
    """What this process and its ended children have used so far."""
    own, children = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = sum(usage.ru_utime + usage.ru_stime for usage in (own, children))
    return Used(cpu, _Fits.seconds, max(own.ru_maxrss, children.ru_maxrss) / _MB)


def used_by_log(log: str | Path) -> Used | None:
    """What the last job that wrote to `log` used, by its last word; None where it has not ended."""
    words = _USED.findall(Path(log).read_text(encoding="utf-8"))
    return Used(*map(float, words[-1])) if words else None


@dataclass(slots=True)
class Stopwatch:
    """Wall and CPU seconds of the block it times (CPU of this process, all threads)."""

    seconds: float = 0.0
    cpu_seconds: float = 0.0


@contextmanager
def stopwatch() -> Iterator[Stopwatch]:
    """Measure the wall and CPU seconds of a block."""
    watch, wall, cpu = Stopwatch(), time.perf_counter(), time.process_time()
    try:
        yield watch
    finally:
        watch.seconds, watch.cpu_seconds = time.perf_counter() - wall, time.process_time() - cpu
