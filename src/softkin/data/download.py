"""Open what is at a URL, and read it within limits of size and time: the server is not trusted."""

from __future__ import annotations

import logging
import queue
import threading
import time
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from urllib.parse import urljoin, urlsplit

import requests
import urllib3.exceptions

from softkin.core.urls import hide_in, is_loopback, without_credentials

logger = logging.getLogger("softkin")

CHUNK_BYTES = 1 << 16
#: Redirects that are followed.
MAX_REDIRECTS = 5
#: A body that comes more slowly than this, over `Patience.timeout_seconds`, has stalled.
SLOWEST_BYTES_PER_SECOND = 1000


class Refused(Exception):
    """What softkin does not do, however often it is tried: such a URL or redirect, so many bytes, so long a wait."""


@dataclass(frozen=True, slots=True)
class Patience:
    """How long and how much is waited for: seconds without an answer, attempts, the first of the doubling pauses (s),
    seconds for all attempts at all sources together, and the bytes that a file has at most, unpacked.
    """

    timeout_seconds: float = 30.0
    attempts: int = 4
    backoff_seconds: float = 1.0
    whole_seconds: float = 1800.0
    max_bytes: int = 4 << 30


PATIENT = Patience()


@contextmanager
def opened(url: str, patience: Patience, ends: float) -> Iterator[Iterator[bytes]]:
    """Yield the chunks of the file at `url`, unpacked where the server has packed it.

    Parameters:
        url: https, or http on this machine.
        patience: the limits.
        ends: when the wait is over, by `time.monotonic()` (s).

    Raises:
        Refused: the URL, a redirect, the size or the time is not allowed.
        requests.RequestException: the server is not there or answers something else.
    """
    with requests.Session() as session, _answer(session, url, patience, ends) as response:
        yield _limited(_unpacked(response, patience, ends), patience.max_bytes)


def check_allowed(url: str) -> None:
    """Refuse a `url` that is neither https nor, on this machine, http.

    Raises:
        Refused: it is something else.
    """
    scheme = urlsplit(url).scheme
    if scheme == "http" and not is_loopback(url):
        raise Refused("http is not encrypted: only https is used beyond this machine")
    if scheme not in ("http", "https"):
        raise Refused(f"'{scheme}' is not used: only https, and http on this machine")


def _answer(session: requests.Session, url: str, patience: Patience, ends: float) -> requests.Response:
    for _ in range(MAX_REDIRECTS + 1):
        check_allowed(url)
        # A proxy is for other machines.
        session.trust_env = not is_loopback(url)
        # Headers can drip, too, which no time-out of a socket notices.
        wait = min(2 * patience.timeout_seconds, ends - time.monotonic())
        if wait <= 0:
            raise Refused(f"the {patience.whole_seconds:.0f} s that retrieval may take are over")
        response = _in_time(lambda url=url: _get(session, url, patience), wait)  # type: ignore[misc]
        if not response.is_redirect:
            response.raise_for_status()
            return response
        target = urljoin(url, response.headers["Location"])
        response.close()
        if urlsplit(target).scheme != urlsplit(url).scheme:
            raise Refused(f"a redirect to another scheme, {without_credentials(target)}, is not followed")
        url = target
    raise Refused(f"more than {MAX_REDIRECTS} redirects")


def _get(session: requests.Session, url: str, patience: Patience) -> requests.Response:
    return session.get(
        url,
        stream=True,
        timeout=patience.timeout_seconds,
        allow_redirects=False,
        headers={"Accept-Encoding": "identity"},
    )


def _in_time(work: Callable[[], requests.Response], seconds: float) -> requests.Response:
    answers: queue.SimpleQueue[Any] = queue.SimpleQueue()

    def run() -> None:
        try:
            answers.put(work())
        except Exception as error:  # noqa: BLE001 (handed to the caller, who raises it)
            answers.put(error)

    threading.Thread(target=run, daemon=True).start()
    try:
        answer = answers.get(timeout=seconds)
    except queue.Empty:
        raise requests.Timeout(f"no answer within {seconds:.3g} s") from None
    if isinstance(answer, Exception):
        raise answer
    response: requests.Response = answer
    return response


def _unpacked(response: requests.Response, patience: Patience, ends: float) -> Iterator[bytes]:
    announced = response.raw.length_remaining
    if announced is not None and announced > patience.max_bytes:
        raise Refused(f"{announced} bytes are announced, more than the {patience.max_bytes} that a file may have")
    encoding = response.headers.get("Content-Encoding", "identity").strip().lower()
    if encoding == "identity":
        yield from _limited(_raw(response, patience, ends), patience.max_bytes)
        return
    if encoding not in ("gzip", "x-gzip", "deflate"):
        raise Refused(f"the body is packed by '{encoding[:40]}', which was not asked for")
    packed = zlib.decompressobj(wbits=47)  # the header tells gzip from zlib
    try:
        for chunk in _limited(_raw(response, patience, ends), patience.max_bytes):
            waiting = chunk
            while waiting:
                yield packed.decompress(waiting, CHUNK_BYTES)
                waiting = packed.unconsumed_tail
    except zlib.error as error:
        raise Refused(f"the body is not packed as it says: {error}") from error
    if not packed.eof:
        raise requests.exceptions.ChunkedEncodingError


def _raw(response: requests.Response, patience: Patience, ends: float) -> Iterator[bytes]:
    since, in_window = time.monotonic(), 0
    while chunk := _chunk(response):
        yield chunk
        in_window += len(chunk)
        now = time.monotonic()
        if now > ends:
            raise Refused(f"the {patience.whole_seconds:.0f} s that retrieval may take are over")
        if now - since > patience.timeout_seconds:
            if in_window < SLOWEST_BYTES_PER_SECOND * (now - since):
                raise requests.Timeout(f"{in_window} bytes in {now - since:.3g} s are no progress")
            since, in_window = now, 0


def _chunk(response: requests.Response) -> bytes:
    try:
        return bytes(response.raw.read1(CHUNK_BYTES, decode_content=False))
    except urllib3.exceptions.ReadTimeoutError as error:
        raise requests.Timeout from error
    except urllib3.exceptions.HTTPError as error:
        raise requests.exceptions.ChunkedEncodingError from error


def _limited(chunks: Iterator[bytes], max_bytes: int) -> Iterator[bytes]:
    size = 0
    for chunk in chunks:
        size += len(chunk)
        if size > max_bytes:
            raise Refused(f"more than the {max_bytes} bytes that a file may have")
        yield chunk


def may_recover(error: BaseException) -> bool:
    """Whether another attempt may go better."""
    if isinstance(error, requests.HTTPError):
        return error.response is not None and (error.response.status_code == 429 or error.response.status_code >= 500)
    if isinstance(error, (requests.exceptions.SSLError, ValueError)):  # a certificate, a URL that is none
        return False
    return isinstance(error, requests.RequestException)


def reason(error: BaseException | None, url: str) -> str:
    """What went wrong at `url`, in words, without its credentials."""
    match error:
        case requests.HTTPError() if error.response is not None:
            text = f"the server answered {error.response.status_code} {error.response.reason}"
        case requests.exceptions.ProxyError():
            text = f"the proxy does not let it through: {_root(error)}"
        case requests.exceptions.SSLError():
            text = f"no trusted connection: {_root(error)}"
        case requests.Timeout():
            text = f"timed out {error}".strip()
        case requests.exceptions.ChunkedEncodingError():
            text = "the transfer broke off: the file is truncated"
        case requests.ConnectionError() if isinstance(_root(error), urllib3.exceptions.NameResolutionError):
            text = "the name of the host is not known here"
        case requests.ConnectionError():
            text = "connection refused or lost"
        case FileNotFoundError():
            text = "no such file"
        case _:
            text = str(error) or type(error).__name__
    return hide_in(text, url)


def _root(error: BaseException) -> object:
    """What is behind an error of requests: its own text repeats the URL."""
    inner: Any = error.args[0] if error.args else error
    return getattr(inner, "reason", None) or inner
