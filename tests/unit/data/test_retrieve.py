"""Retrieval against a real server on loopback that misbehaves in each way the real ones do."""

from __future__ import annotations

import contextlib
import hashlib
import threading
import time
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from softkin.core.errors import RetrievalError
from softkin.data.retrieve import Patience, retrieve, take_own_file

CONTENT = b'{"train": {}}' * 5000
SHA256 = hashlib.sha256(CONTENT).hexdigest()


class Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.requests: list[str] = []

    def url(self, behaviour: str) -> str:
        return f"http://127.0.0.1:{self.server_port}/{behaviour}/FINGER.json"


class Handler(BaseHTTPRequestHandler):
    server: Server

    def do_GET(self) -> None:
        behaviour = self.path.split("/")[1]
        first = behaviour not in self.server.requests
        self.server.requests.append(behaviour)
        if behaviour == "missing":
            return self.send_error(404)
        if behaviour == "busy" or (behaviour == "busy-once" and first):
            return self.send_error(503)
        if behaviour == "slow":
            time.sleep(2)
        body = b"something else" if behaviour == "wrong" else CONTENT
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        cut = behaviour == "truncated" or (behaviour == "truncated-once" and first)
        with contextlib.suppress(OSError):  # the client has hung up: it timed out
            self.wfile.write(body[: len(body) // 2] if cut else body)
        return None

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def server() -> Iterator[Server]:
    server = Server()
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    yield server
    server.shutdown()
    server.server_close()


def get(destination: Path, *urls: str, mirror: str | None = None) -> str:
    return retrieve(
        dataset="finger",
        file="FINGER.json",
        urls=urls,
        sha256=SHA256,
        destination=destination,
        mirror=mirror,
        patience=Patience(timeout_seconds=0.5, attempts=2, backoff_seconds=0.01),
    )


@pytest.mark.parametrize(
    ("behaviour", "says", "requests"),
    [
        ("missing", "404", 1),
        ("busy", "503", 2),
        ("slow", "timed out", 2),
        ("wrong", "wrong file: sha256 is", 1),
        ("truncated", "truncated", 2),
    ],
)
def test_a_bad_source_is_named_and_leaves_nothing(
    server: Server, tmp_path: Path, behaviour: str, says: str, requests: int
) -> None:
    with pytest.raises(RetrievalError) as error:
        get(tmp_path / "raw.json", server.url(behaviour))
    for part in ("finger", server.url(behaviour), says, "SOFTKIN_DATA_MIRROR"):
        assert part in str(error.value)
    assert list(tmp_path.iterdir()) == []
    assert len(server.requests) == requests


def test_a_refused_connection_is_named(server: Server, tmp_path: Path) -> None:
    url = server.url("good")
    server.shutdown()
    server.server_close()
    with pytest.raises(RetrievalError, match="connection refused"):
        get(tmp_path / "raw.json", url)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("behaviour", ["busy-once", "truncated-once"])
def test_a_source_that_recovers_is_tried_again(server: Server, tmp_path: Path, behaviour: str) -> None:
    assert get(tmp_path / "raw.json", server.url(behaviour)) == server.url(behaviour)
    assert (tmp_path / "raw.json").read_bytes() == CONTENT
    assert len(server.requests) == 2


def test_sources_are_tried_in_order_mirror_first(server: Server, tmp_path: Path) -> None:
    source = get(tmp_path / "raw.json", server.url("good"), mirror=server.url("missing").removesuffix("/FINGER.json"))
    assert source == server.url("good")
    assert server.requests == ["missing", "good"]
    assert (tmp_path / "raw.json").read_bytes() == CONTENT


def test_a_folder_mirror_serves_without_a_request(server: Server, tmp_path: Path) -> None:
    (tmp_path / "FINGER.json").write_bytes(CONTENT)
    assert get(tmp_path / "out" / "raw.json", server.url("good"), mirror=str(tmp_path)).startswith("mirror")
    assert server.requests == []


def test_a_wrong_file_in_the_mirror_is_not_used(server: Server, tmp_path: Path) -> None:
    (tmp_path / "FINGER.json").write_bytes(CONTENT[:-1])
    assert get(tmp_path / "raw.json", server.url("good"), mirror=str(tmp_path)) == server.url("good")
    assert (tmp_path / "raw.json").read_bytes() == CONTENT


def test_a_wrong_file_does_not_replace_a_right_one(server: Server, tmp_path: Path) -> None:
    (tmp_path / "raw.json").write_bytes(CONTENT)
    with pytest.raises(RetrievalError):
        get(tmp_path / "raw.json", server.url("wrong"))
    assert (tmp_path / "raw.json").read_bytes() == CONTENT


@pytest.mark.parametrize("sha256", [None, SHA256])
def test_a_file_of_ones_own_is_copied(tmp_path: Path, sha256: str | None) -> None:
    (tmp_path / "arm.csv").write_bytes(CONTENT)
    destination = tmp_path / "results" / "raw.json"
    take_own_file(dataset="arm", file=str(tmp_path / "arm.csv"), destination=destination, sha256=sha256)
    assert destination.read_bytes() == CONTENT


@pytest.mark.parametrize(
    ("file", "sha256", "says"),
    [("amr.csv", None, "no such file"), ("arm.csv", "0" * 64, "wrong file: sha256 is"), (".", None, "directory")],
)
def test_a_file_of_ones_own_that_is_not_there_or_not_registered_is_an_error(
    tmp_path: Path, file: str, sha256: str | None, says: str
) -> None:
    (tmp_path / "arm.csv").write_bytes(CONTENT)
    with pytest.raises(RetrievalError) as error:
        take_own_file(dataset="arm", file=str(tmp_path / file), destination=tmp_path / "raw.json", sha256=sha256)
    for part in ("'arm'", says, "\n  fix: "):
        assert part in str(error.value)
    assert [path.name for path in tmp_path.iterdir()] == ["arm.csv"]
