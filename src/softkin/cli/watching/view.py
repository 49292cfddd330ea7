"""The log handler that takes the place of Snakemake's own on the terminal, from `onstart` to the end of the run."""

from __future__ import annotations

import logging
import os
import re
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import TextIO

from softkin.cli.watching.job import Job
from softkin.cli.watching.lines import ended_line, screen_lines
from softkin.cli.watching.progress import Progress
from softkin.core.durations import readable
from softkin.core.terminal import CLOCK, ON_A_SCREEN

#: The name that Snakemake gives the handler that writes to the terminal.
SNAKEMAKES_OWN = "DefaultStreamHandler"
#: A line of a job's log that is a warning of softkin; Python's own name a file and a category, and stay in the log.
WARNING = re.compile(r"^\S+ \S+ WARNING (?!.*:\d+: \w*Warning: )(.+)$", re.MULTILINE)
#: Snakemake's events that say how far the run is.
EVENTS = ("job_started", "group_info", "job_finished", "job_error")
CLEAR_BELOW = "\033[J"


class View(logging.Handler):
    """Shows a run from Snakemake's events, and passes warnings and errors on to `own`, Snakemake's handler.

    On a terminal one block of lines is drawn over itself once a second, and jobs write to their logs only; anywhere
    else each job that ends is one line with the time of day, and jobs write to the terminal too.
    """

    def __init__(
        self,
        progress: Progress,
        own: logging.StreamHandler[TextIO],
        title: str,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__()
        self.progress, self.own, self.title, self.clock = progress, own, title, clock
        self.stream = own.stream
        self.is_screen = self.stream.isatty() and os.environ.get("TERM") != "dumb"
        self._drawn = 0
        self._drawing = threading.RLock()
        self._ended = threading.Event()
        self._ticker: threading.Thread | None = None

    def start(self, logger: logging.Logger) -> None:
        """Take the place of Snakemake's handler, and start to draw."""
        logger.removeHandler(self.own)
        logger.addHandler(self)
        if self.is_screen:
            os.environ[ON_A_SCREEN] = "1"
            self._ticker = threading.Thread(target=self._tick, daemon=True)
            self._ticker.start()

    def finish(self, logger: logging.Logger) -> None:
        """Write one closing line and give Snakemake its handler back."""
        self.close()
        logger.removeHandler(self)
        logger.addHandler(self.own)
        took = readable(self.clock() - self.progress.start)
        failed = f", {self.progress.failed} failed" if self.progress.failed else ""
        with suppress(OSError):
            at = "" if self.is_screen else f"{self._time_of_day()} "
            jobs = f"{self.progress.done} of {len(self.progress.jobs)} jobs"
            self._write(f"{at}{self.title}: {jobs} in {took}{failed}\n")

    def close(self) -> None:
        """Stop drawing, and leave the terminal clean; also called when Snakemake ends in an error of its own."""
        self._ended.set()
        if self._ticker:
            self._ticker.join()
            self._ticker = None
            os.environ.pop(ON_A_SCREEN, None)
        with self._drawing, suppress(OSError):
            self._clear()
        super().close()

    def emit(self, record: logging.LogRecord) -> None:
        """Note an event in the progress, and show warnings and errors.

        A closed pipe or terminal (`snakemake | head`) must not stop the run: Snakemake would wait for the job whose
        end it was reporting. The log file in .snakemake/log has all messages.
        """
        event, now = getattr(record, "event", None), self.clock()
        if event not in EVENTS and record.levelno < logging.WARNING:
            return
        with self._drawing:
            ended = None
            if event == "job_started":
                for number in record.__dict__["jobs"]:
                    self.progress.begin(number, now)
            elif event == "group_info":  # jobs that one job of a cluster does, and whose own start nobody tells
                for job in record.__dict__["jobs"]:
                    self.progress.begin(job.jobid, now)
            elif event == "job_finished":
                ended = self.progress.end(record.__dict__["job_id"], now)
            elif event == "job_error":
                ended = self.progress.end(record.__dict__["jobid"], now, failed=True)
            with suppress(OSError):
                self._clear()
                self._show_ended(ended, now)
                if record.levelno >= logging.WARNING:
                    self.own.handle(record)
                self._draw()

    def _show_ended(self, job: Job | None, now: float) -> None:
        if job is None:
            return
        if not self.is_screen:
            self._write(ended_line(job, self.progress, now, self._time_of_day()) + "\n")
        elif job.log is not None and job.log.is_file() and not job.failed:  # of a failed one Snakemake shows the log
            for warning in WARNING.findall(job.log.read_text(encoding="utf-8", errors="replace")):
                self._write(f"{job.name}: {warning}\n")

    @staticmethod
    def _time_of_day() -> str:
        """What a line of a log begins with."""
        return time.strftime(CLOCK)

    def _tick(self) -> None:
        while not self._ended.wait(1.0):
            with self._drawing, suppress(OSError):
                self._clear()
                self._draw()

    def _clear(self) -> None:
        if self._drawn:
            self._write(f"\033[{self._drawn}F{CLEAR_BELOW}")
            self._drawn = 0

    def _draw(self) -> None:
        if not self.is_screen or self._ended.is_set():
            return
        width, height = os.get_terminal_size(self.stream.fileno())
        # A terminal of unknown size reports 0.
        lines = screen_lines(
            self.progress, self.clock(), title=self.title, width=width or 80, height=(height or 24) - 1
        )
        self._write("".join(f"{line}\n" for line in lines))
        self._drawn = len(lines)

    def _write(self, text: str) -> None:
        self.stream.write(text)
        self.stream.flush()
