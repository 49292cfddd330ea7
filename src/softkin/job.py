"""What every workflow script needs around its one call: a log, clear errors, one thread per core it was given."""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from softkin.interface import SoftkinError

logger = logging.getLogger("softkin")


@contextmanager
def job(log: str, label: str) -> Iterator[None]:
    """Run a job: messages go to the file `log` and, from level INFO, to the terminal, marked with `label`.

    A `SoftkinError` ends the job with its message alone and exit status 1; anything else is a defect of ours and
    keeps its traceback, in the log file too.
    """
    Path(log).parent.mkdir(parents=True, exist_ok=True)
    to_file = logging.FileHandler(log, mode="w", encoding="utf-8")
    to_file.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    to_terminal = logging.StreamHandler(sys.stderr)
    to_terminal.setLevel(logging.INFO)
    to_terminal.setFormatter(logging.Formatter(f"{label}: %(message)s"))
    logger.handlers = [to_file, to_terminal]
    logger.setLevel(logging.DEBUG)
    logger.propagate = False
    logging.captureWarnings(True)
    logging.getLogger("py.warnings").addHandler(to_file)
    try:
        yield
    except SoftkinError as error:
        logger.error("%s", error)
        raise SystemExit(1) from error
    except BaseException:
        logger.handlers = [to_file]
        logger.exception("the job stopped")
        raise
    finally:
        logger.handlers = []
        logger.propagate = True
        logging.captureWarnings(False)
        logging.getLogger("py.warnings").removeHandler(to_file)
        to_file.close()


@dataclass(slots=True)
class Stopwatch:
    """Wall and CPU seconds of the block it times (CPU of this process, all threads)."""

    seconds: float = 0.0
    cpu_seconds: float = 0.0


@contextmanager
def stopwatch() -> Iterator[Stopwatch]:
    """Time a block."""
    watch, wall, cpu = Stopwatch(), time.perf_counter(), time.process_time()
    try:
        yield watch
    finally:
        watch.seconds, watch.cpu_seconds = time.perf_counter() - wall, time.process_time() - cpu
