from __future__ import annotations

import importlib.util
import json
import sys
import threading
import time
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from softkin.campaigns.schedules import APPRISE
from softkin.campaigns.verdict import FAILED, GOT_WORSE, SAME_RESULTS, Verdict
from softkin.cli import campaign, notification
from softkin.cli.notification import URLS, shown, take_urls, tell
from softkin.core.errors import ConfigError
from tests.conftest import HOUSE

WORSE = Verdict(GOT_WORSE, ["arm, test: the mean error of a marker is 2 mm, before 1 mm."])


class Apprise:
    """Stands in for the library: it knows json:// alone, and fails where the host is 'down'."""

    sent: ClassVar[list[dict[str, Any]]] = []

    def __init__(self) -> None:
        self.urls: list[str] = []

    def add(self, url: str) -> bool:
        self.urls += [url] * url.startswith("json://")
        return bool(self.urls)

    def __bool__(self) -> bool:
        return bool(self.urls)

    def notify(self, **message: Any) -> bool:
        Apprise.sent.append(message)
        return "down" not in self.urls[0]


@pytest.fixture
def _library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Apprise, "sent", [])
    monkeypatch.setitem(sys.modules, "apprise", SimpleNamespace(Apprise=Apprise, __spec__=object()))


@pytest.mark.usefixtures("_library")
def test_urls_are_taken_out_of_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(URLS, " json://one\n json://two ")
    assert take_urls() == ["json://one", "json://two"]
    assert take_urls() == []


@pytest.mark.usefixtures("_library")
def test_every_url_gets_the_verdict_and_one_that_fails_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    tell(WORSE, command=None, urls=["json://me:hunter22@down/token", "json://up"])
    assert [(one["title"], one["notify_type"]) for one in Apprise.sent] == [
        ("softkin: Something got worse", "warning")
    ] * 2
    assert Apprise.sent[1]["body"] == WORSE.as_markdown()
    said = capsys.readouterr().err
    assert said == f"softkin: the verdict could not be sent to json://***, number 1 of {URLS}\n"


@pytest.mark.usefixtures("_library")
@pytest.mark.parametrize(("outcome", "kind"), [(SAME_RESULTS, "success"), (FAILED, "failure")])
def test_the_kind_of_message_is_that_of_the_outcome(outcome: str, kind: str) -> None:
    tell(Verdict(outcome), command=None, urls=["json://up"])
    assert Apprise.sent[0]["notify_type"] == kind


@pytest.mark.usefixtures("_library")
def test_a_url_that_apprise_does_not_know_is_refused_before_anything_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(URLS, "json://one slac://tokenA/tokenB")
    assert campaign.main(["--directory", str(tmp_path)]) == 1
    said = capsys.readouterr().err
    assert f"{URLS}: Apprise knows no such URL: slac://***, number 2" in said
    assert "token" not in said
    assert not (tmp_path / "results").exists()


def test_urls_without_apprise_are_an_error_that_shows_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(URLS, "json://me:hunter22@localhost/")
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    with pytest.raises(ConfigError, match="Apprise, which sends to them, is not installed") as error:
        take_urls()
    assert f"pip install '{APPRISE}'" in str(error.value)
    assert "hunter22" not in str(error.value)


def test_the_extra_installs_the_version_that_is_named() -> None:
    assert f'notify = [\n  "{APPRISE}",\n]' in (HOUSE / "pyproject.toml").read_text()


def test_a_command_that_hangs_is_ended_with_its_children(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(notification, "PATIENCE", 0.3)
    began = time.monotonic()
    tell(WORSE, command=f"sleep 60 & echo $! > '{tmp_path}/child'; wait", urls=[])
    assert time.monotonic() - began < 10
    assert "the notification was ended, since it took more than 0.3 seconds: sleep 60" in capsys.readouterr().err
    child = Path("/proc", (tmp_path / "child").read_text().strip(), "cmdline")
    while child.exists() and child.read_bytes():  # a child that has ended and nobody waits for has no command
        assert time.monotonic() - began < 10
        time.sleep(0.02)


def test_a_command_that_fails_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tell(WORSE, command=f"cat > '{tmp_path}/told'; exit 5", urls=[])
    assert (tmp_path / "told").read_text() == WORSE.as_markdown()
    assert "the notification ended with exit code 5" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("url", "text"),
    [("tgram://bottoken/chat", "tgram://***"), ("mailto://me:pw@example.org?x=1", "mailto://***"), ("secret", "***")],
)
def test_nothing_but_the_scheme_is_shown(url: str, text: str) -> None:
    assert shown(url) == text


@pytest.fixture
def server() -> Iterator[tuple[int, list[dict[str, Any]]]]:
    """Port of an HTTP server on this machine, and what was posted to it; to /refused it answers 500."""
    posted: list[dict[str, Any]] = []

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            posted.append(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(500 if "refused" in self.path else 200)
            self.end_headers()

        def log_message(self, *_: Any) -> None:
            return

    with HTTPServer(("127.0.0.1", 0), Handler) as http:
        thread = threading.Thread(target=http.serve_forever)
        thread.start()
        yield http.server_port, posted
        http.shutdown()
        thread.join()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of what Apprise imports
def test_apprise_itself_sends_to_a_server(
    server: tuple[int, list[dict[str, Any]]], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if importlib.util.find_spec("apprise") is None:
        pytest.skip(f"Apprise is not installed: .venv/bin/pip install '{APPRISE}'")
    port, posted = server
    monkeypatch.setenv(URLS, f"json://me:hunter22@127.0.0.1:{port}/ json://me:hunter22@127.0.0.1:{port}/refused")
    tell(WORSE, command=None, urls=take_urls())
    assert [(one["title"], one["type"]) for one in posted] == [("softkin: Something got worse", "warning")] * 2
    assert "mean error of a marker is 2 mm" in posted[0]["message"]
    said = capsys.readouterr()
    assert "could not be sent to json://***, number 2" in said.err
    assert "hunter22" not in said.out + said.err
    monkeypatch.setenv(URLS, "nonsense://hunter22")
    with pytest.raises(ConfigError, match="knows no such URL") as error:
        take_urls()
    assert "hunter22" not in str(error.value)
