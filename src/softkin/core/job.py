"""The frame around the one call of a workflow script: its log, its error messages, its record."""

from __future__ import annotations

import gc
import logging
import os
import sys
import traceback
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from pathlib import Path
from types import TracebackType
from typing import Any

from softkin.core.clocks import used
from softkin.core.credentials import hide_known
from softkin.core.damage import check_ends
from softkin.core.errors import SoftkinError
from softkin.core.explained import explained
from softkin.core.job_records import forget_job, record_job
from softkin.core.terminal import CLOCK, ON_A_SCREEN

logger = logging.getLogger("softkin")

# Python looks for circles of dead objects each 700 that come to those there are, which took a sixth of the imports of a
# job and a tenth of its figures. Scripts import this before what is large; who imports softkin to use it does not.
gc.set_threshold(20_000, 10, 10)


class Discreet(logging.Formatter):
    """A formatter that hides the credentials of the configuration, whoever names them."""

    def format(self, record: logging.LogRecord) -> str:
        """The text of a record."""
        return hide_known(super().format(record))


def _print_discreetly(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    sys.stderr.write(hide_known("".join(traceback.format_exception(kind, error, trace))))


@contextmanager
def job(
    log: str,
    label: str,
    outputs: Iterable[str] = (),
    inputs: Iterable[str] = (),
    params: Mapping[str, Any] | None = None,
    kept: Iterable[str] = (),
) -> Iterator[None]:
    """Run a job: messages go to the file `log` and, from level INFO, to the terminal, marked with the time of day and
    `label`. Under `ON_A_SCREEN` nothing goes to the terminal, and what libraries write to it goes to the file.

    Where it succeeds, hashes of `outputs` and `params` are recorded, beside what is known of files `kept` as they are.

    A `SoftkinError` ends the job with its message alone and exit status 1, and so does an error that a damaged one of
    its `inputs`, a library's store or the machine explains; the traceback is in the log file alone. Any other exception
    is a defect of softkin and keeps its traceback.
    """
    written, kept = list(outputs), list(kept)
    if written:
        forget_job(log, kept)
    Path(log).parent.mkdir(parents=True, exist_ok=True)
    file = Path(log).open("w", encoding="utf-8")  # noqa: SIM115 (closed below, after the handlers that write to it)
    to_file = logging.StreamHandler(file)
    to_file.setFormatter(Discreet("%(asctime)s %(levelname)s %(message)s"))
    to_terminal = logging.StreamHandler(sys.stderr)
    to_terminal.setLevel(logging.INFO)
    to_terminal.setFormatter(Discreet(f"%(asctime)s {label}: %(message)s", CLOCK))
    screen = ON_A_SCREEN in os.environ
    logger.handlers = [to_file] if screen else [to_file, to_terminal]
    logger.setLevel(logging.DEBUG)
    logger.propagate = False
    logging.captureWarnings(True)
    logging.getLogger().addHandler(to_file)  # warnings too; without a handler MAPIE gives it one that prints
    try:
        with _terminal_into(file.fileno()) if screen else nullcontext():
            check_ends(inputs)
            yield
        if written:
            record_job(log, written, params, kept)
    except SoftkinError as error:
        logger.error("%s", error)
        raise SystemExit(1) from error
    except BaseException as error:
        handlers, logger.handlers = logger.handlers, [to_file]
        logger.exception("the job stopped")
        known = explained(error, inputs) if isinstance(error, Exception) else None
        if known is None:
            sys.excepthook = _print_discreetly
            raise
        logger.handlers = handlers
        logger.error("%s", known)
        raise SystemExit(1) from error
    finally:
        logger.handlers = [to_file]
        logger.info("%s", used())
        logger.handlers = []
        logger.propagate = True
        logging.captureWarnings(False)
        logging.getLogger().removeHandler(to_file)
        file.close()


@contextmanager
def _terminal_into(file: int) -> Iterator[None]:
    """Send what this process and its children write to standard output and error to the open `file`."""
    kept = {number: os.dup(number) for number in (1, 2)}
    sys.stdout.flush()
    try:
        for number in kept:
            os.dup2(file, number)
        yield
    finally:
        sys.stdout.flush()
        for number, copy in kept.items():
            os.dup2(copy, number)
            os.close(copy)
