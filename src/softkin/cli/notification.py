"""Tell somebody how a campaign ended: by a command of the user's choice, and by URLs of Apprise."""

from __future__ import annotations

import importlib
import importlib.util
import logging
import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any

from softkin.campaigns.schedules import APPRISE
from softkin.campaigns.verdict import HEADINGS, Verdict
from softkin.core.errors import ConfigError

#: Environment variable: URLs of Apprise, blanks between them.
URLS = "NOTIFY_URLS"
#: Seconds that the command has: a service that does not end is not started the next night.
PATIENCE = 60.0
#: Apprise's words for exit codes; all others are failures.
TYPES = {0: "success", 3: "warning", 4: "warning"}


def take_urls() -> list[str]:
    """The URLs of the environment, which has them no more: no job sees them.

    Raises:
        ConfigError: there are some, and Apprise is not installed or does not know one of them. It shows none of them.
    """
    urls = os.environ.pop(URLS, "").split()
    if urls and importlib.util.find_spec("apprise") is None:
        raise ConfigError(
            "there are URLs, and Apprise, which sends to them, is not installed",
            where=URLS,
            fix=f"install it by .venv/bin/pip install '{APPRISE}', or unset {URLS}",
        )
    for number, url in enumerate(urls, 1):
        if not _sender(url):
            raise ConfigError(
                f"Apprise knows no such URL: {shown(url)}, number {number}",
                where=URLS,
                fix="correct it, or leave it out",
            )
    return urls


def shown(url: str) -> str:
    """A URL of Apprise as it may be shown: tokens stand anywhere in it but in its scheme."""
    scheme, separator, _ = url.partition("://")
    return f"{scheme}://***" if separator and scheme.isalnum() else "***"


def tell(verdict: Verdict, *, command: str | None, urls: Sequence[str]) -> None:
    """Give a verdict to a command on its standard input, where SOFTKIN_OUTCOME says how it ended, and send it to URLs.

    A notification that fails is said on standard error, and changes nothing else.
    """
    for problem in (*(_run(command, verdict) if command else ()), *_send(urls, verdict)):
        print(f"softkin: {problem}", file=sys.stderr)


def _run(command: str, verdict: Verdict) -> Iterator[str]:
    environment = os.environ | {"SOFTKIN_OUTCOME": verdict.outcome, "SOFTKIN_EXIT_CODE": str(verdict.exit_code)}
    with subprocess.Popen(
        command, shell=True, stdin=subprocess.PIPE, text=True, env=environment, start_new_session=True
    ) as told:
        try:
            told.communicate(verdict.as_markdown(), timeout=PATIENCE)
        except BaseException as error:
            with suppress(ProcessLookupError):
                os.killpg(told.pid, signal.SIGKILL)
            if not isinstance(error, subprocess.TimeoutExpired):
                raise
            yield f"the notification was ended, since it took more than {PATIENCE:g} seconds: {command}"
            return
    if told.returncode:
        yield f"the notification ended with exit code {told.returncode}: {command}"


def _send(urls: Sequence[str], verdict: Verdict) -> Iterator[str]:
    title, kind = f"softkin: {HEADINGS[verdict.outcome]}", TYPES.get(verdict.exit_code, "failure")
    for number, url in enumerate(urls, 1):
        sent = _sender(url).notify(body=verdict.as_markdown(), title=title, notify_type=kind, body_format="markdown")
        if not sent:
            yield f"the verdict could not be sent to {shown(url)}, number {number} of {URLS}"


def _sender(url: str) -> Any:
    """What sends to a URL; it is false where Apprise does not know the URL. It says nothing by itself."""
    quiet = logging.getLogger("apprise")
    quiet.propagate, quiet.handlers = False, [logging.NullHandler()]
    sender = importlib.import_module("apprise").Apprise()
    sender.add(url)
    return sender
