"""Servers that answer, that do not, and that are not there, on this machine."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from typing import Any

import pytest
from mlflow.environment_variables import MLFLOW_HTTP_REQUEST_MAX_RETRIES, MLFLOW_HTTP_REQUEST_TIMEOUT

from softkin.core.errors import StoreError
from softkin.tracking.lock import locked
from softkin.tracking.server import check_answers
from softkin.tracking.store import client_of, create_store


@contextmanager
def answering(status: int) -> Iterator[str]:
    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(status)
            self.end_headers()

        def log_message(self, format: str, *arguments: object) -> None:
            pass

    server = HTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()


@pytest.mark.parametrize("status", [200, 401, 404])
def test_whatever_a_server_says_it_answers(status: int) -> None:
    with answering(status) as uri:
        check_answers(uri, patience=5)


def test_a_proxy_does_not_answer_for_its_server() -> None:
    with answering(503) as uri, pytest.raises(StoreError, match="a proxy says 503 in its place"):
        check_answers(uri, patience=0.2)


def test_a_server_that_says_nothing() -> None:
    with socket.socket() as deaf:
        deaf.bind(("127.0.0.1", 0))
        deaf.listen()
        with pytest.raises(StoreError, match="it says nothing"):
            check_answers(f"http://127.0.0.1:{deaf.getsockname()[1]}", patience=0.2)


def test_files_are_not_asked() -> None:
    check_answers("sqlite:////nowhere/mlflow.db", patience=0)


def lock(tracking_uri: str) -> None:
    with locked(tracking_uri, "finger"):
        pass


@pytest.mark.parametrize("ask", [create_store, client_of, lock])
def test_a_dead_server_is_one_sentence_within_seconds(
    ask: Callable[[str], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("softkin.tracking.server.check_answers.__defaults__", (1.0,))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    started = time.monotonic()
    with pytest.raises(StoreError) as caught:
        ask(f"http://me:secret@127.0.0.1:{port}")
    assert 0.4 < time.monotonic() - started < 10
    assert f"@127.0.0.1:{port}: the tracking server does not answer: nothing listens there" in str(caught.value)
    assert "secret" not in str(caught.value)


def test_mlflow_gives_up_sooner_than_by_default() -> None:
    retries: Any = MLFLOW_HTTP_REQUEST_MAX_RETRIES
    timeout: Any = MLFLOW_HTTP_REQUEST_TIMEOUT
    assert retries.get() < retries.default
    assert timeout.get() < timeout.default
