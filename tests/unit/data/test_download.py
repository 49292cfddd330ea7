from __future__ import annotations

import time

import pytest
import requests

from softkin.data.download import Patience, Refused, check_allowed, may_recover, opened, reason
from tests.unit.data.misbehaving import CONTENT, Server

QUICK = Patience(timeout_seconds=1.5, attempts=2, backoff_seconds=0.01, whole_seconds=3.0, max_bytes=1_000_000)


def read(url: str, patience: Patience = QUICK) -> bytes:
    with opened(url, patience, time.monotonic() + patience.whole_seconds) as chunks:
        return b"".join(chunks)


@pytest.mark.parametrize("behaviour", ["good", "redirect", "packed"])
def test_a_file_comes_whole_through_redirects_and_unpacked(server: Server, behaviour: str) -> None:
    assert read(server.url(behaviour)) == CONTENT


@pytest.mark.parametrize(
    ("behaviour", "says"),
    [
        ("announced", "99999999999 bytes are announced"),
        ("endless", "more than the 1000000 bytes"),
        ("packed-bomb", "more than the 1000000 bytes"),
        ("packed-otherwise", "packed by 'br'"),
        ("redirect-ftp", "another scheme, ftp://"),
        ("redirect-file", "another scheme, file://"),
        ("redirect-https", "another scheme, https://"),
        ("redirect-away", "http is not encrypted"),
        ("redirect-loop", "more than 5 redirects"),
    ],
)
def test_what_no_file_needs_is_refused(server: Server, behaviour: str, says: str) -> None:
    start = time.monotonic()
    with pytest.raises(Refused, match=says):
        read(server.url(behaviour))
    assert time.monotonic() - start < 2


@pytest.mark.parametrize("behaviour", ["drip", "drip-headers"])
def test_a_byte_now_and_then_is_no_progress(server: Server, behaviour: str) -> None:
    start = time.monotonic()
    with pytest.raises(requests.Timeout, match=r"no progress|no answer within"):
        read(server.url(behaviour), Patience(timeout_seconds=0.3))
    assert time.monotonic() - start < 2


def test_the_whole_time_is_limited(server: Server) -> None:
    patience = Patience(timeout_seconds=5, whole_seconds=0.3)
    with pytest.raises(Refused, match="that retrieval may take are over"):
        read(server.url("drip"), patience)
    with (
        pytest.raises(Refused, match="that retrieval may take are over"),
        opened(server.url("good"), patience, time.monotonic() - 1),
    ):
        pass


def test_a_packed_body_that_is_cut_off_is_no_file(server: Server) -> None:
    with pytest.raises(requests.exceptions.ChunkedEncodingError):
        read(server.url("packed-cut"))


@pytest.mark.parametrize(
    "url",
    ["http://example.org/a", "ftp://127.0.0.1/a", "file:///etc/passwd", "http://127.0.0.1.a.org/", "a.json"],
)
def test_only_https_is_used_beyond_this_machine(url: str) -> None:
    with pytest.raises(Refused):
        check_allowed(url)


@pytest.mark.parametrize(
    "url", ["https://example.org/a", "http://127.0.0.1:8000/a", "http://localhost/a", "http://[::1]/"]
)
def test_https_and_this_machine_are_used(url: str) -> None:
    check_allowed(url)


def test_the_true_cause_is_said_and_no_credential(monkeypatch: pytest.MonkeyPatch, server: Server) -> None:
    plain = server.url("good").replace("http://", "https://me:hunter22@") + "?token=1a2b3c"
    with pytest.raises(requests.exceptions.SSLError) as no_certificate:
        read(plain)
    said = reason(no_certificate.value, plain)
    assert said.startswith("no trusted connection: ")
    assert "hunter22" not in said
    assert "1a2b3c" not in said
    assert not may_recover(no_certificate.value)
    monkeypatch.setenv("HTTPS_PROXY", "http://127.0.0.1:9")
    monkeypatch.setenv("NO_PROXY", "")
    with pytest.raises(requests.exceptions.ProxyError) as no_proxy:
        read("https://example.org/robot.json?token=1a2b3c")
    assert reason(no_proxy.value, "https://example.org/robot.json?token=1a2b3c").startswith("the proxy does not let")


def test_credentials_of_a_url_are_used(server: Server) -> None:
    assert read(server.url("good").replace("http://", "http://me:hunter22@")) == CONTENT
    assert server.authorisations == ["Basic bWU6aHVudGVyMjI="]
