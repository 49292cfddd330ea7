"""Retrieve the file of a dataset: a published one from the mirror or its URLs, checked by its hash before it is put in
place; one's own is copied, so that a run keeps what it was made from.
"""

from __future__ import annotations

import logging
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlparse

import pooch
import requests
from tenacity import RetryError, Retrying, retry_if_exception, stop_after_attempt, wait_exponential

from softkin.core.errors import RetrievalError
from softkin.core.files import replacing

logger = logging.getLogger("softkin")


class WrongHash(Exception):
    """The bytes that came are not the bytes that were registered."""


@dataclass(frozen=True, slots=True)
class Patience:
    """How long a source is waited for: seconds of a request, attempts, and the first of the doubling pauses (s)."""

    timeout_seconds: float = 30.0
    attempts: int = 4
    backoff_seconds: float = 1.0


def retrieve(
    *,
    dataset: str,
    file: str,
    urls: Sequence[str],
    sha256: str,
    destination: str | Path,
    mirror: str | None = None,
    patience: Patience = Patience(),
) -> str:
    """Put the registered file of a published dataset in place, and return the source that it came from.

    Sources are tried in order: `mirror`, then `urls`. A source that may recover (time-out, refused connection, broken
    transfer, status 429 or 5xx) is tried several times with exponential back-off. Bytes go to a temporary file, are
    checked against `sha256`, then renamed into place.

    Parameters:
        dataset: name of the dataset.
        file: name of the file, in the mirror and in messages.
        urls: where to download it.
        sha256: of its content, hexadecimal; anything else is refused.
        destination: path to put it at.
        mirror: a folder, or a URL prefix, that holds `file`; None where there is none.
        patience: time-out, attempts and back-off.

    Raises:
        RetrievalError: no source gave the file; says what each of them answered.
    """
    answers = []
    for source, fetch in _sources(file, urls, mirror, patience.timeout_seconds):
        try:
            for attempt in _attempts(source, patience):
                with attempt, replacing(destination) as temporary:
                    fetch(temporary)
                    _check(temporary, sha256)
        except RetryError as error:
            answers.append(f"{source}: {_reason(error.last_attempt.exception())} ({patience.attempts} attempts)")
        except (WrongHash, OSError) as error:
            answers.append(f"{source}: {_reason(error)}")
        else:
            logger.info("retrieved %s (%d bytes)", source, Path(destination).stat().st_size)
            return source
        logger.warning("%s", answers[-1])
    raise RetrievalError(
        "\n  ".join([f"no source gave {file}", *answers]),
        where=f"dataset '{dataset}'",
        fix=f"check the internet connection, or put {file} (sha256 {sha256}) into a folder and name that folder, or a "
        "URL prefix, in the variable SOFTKIN_DATA_MIRROR or in the configuration key `data_mirror`",
    )


def _attempts(source: str, patience: Patience) -> Retrying:
    return Retrying(
        stop=stop_after_attempt(patience.attempts),
        wait=wait_exponential(multiplier=patience.backoff_seconds, max=30),
        retry=retry_if_exception(_may_recover),
        before_sleep=lambda state: logger.warning(
            "%s failed (%s); trying again in %.1f s",
            source,
            _reason(state.outcome.exception() if state.outcome else None),
            state.next_action.sleep if state.next_action else 0.0,
        ),
    )


def take_own_file(*, dataset: str, file: str, destination: str | Path, sha256: str | None = None) -> None:
    """Copy a `file` of one's own to `destination`, checked against `sha256` where one is registered.

    Raises:
        RetrievalError: the file is not there or is not the registered one.
    """
    try:
        with replacing(destination) as temporary:
            _copy(Path(file), temporary)
            if sha256 is not None:
                _check(temporary, sha256)
    except (WrongHash, OSError) as error:
        raise RetrievalError(
            _reason(error),
            where=f"dataset '{dataset}', file {file}",
            fix="correct `file` or `sha256` of its entry in config/datasets.yaml; a relative path starts in the "
            "working directory of the run",
        ) from error
    logger.info("copied %s (%d bytes)", file, Path(destination).stat().st_size)


def _sources(
    file: str, urls: Sequence[str], mirror: str | None, timeout: float
) -> Iterator[tuple[str, Callable[[Path], None]]]:
    if mirror and urlparse(mirror).scheme in ("http", "https"):
        urls = [f"{mirror.rstrip('/')}/{file}", *urls]
    elif mirror:
        path = Path(mirror.removeprefix("file://")) / file
        yield f"mirror {path}", lambda temporary: _copy(path, temporary)
    for url in urls:
        yield url, lambda temporary, url=url: _download(url, temporary, timeout)  # type: ignore[misc]


def _copy(source: Path, temporary: Path) -> None:
    shutil.copyfile(source, temporary)


def _download(url: str, temporary: Path, timeout: float) -> None:
    logger.info("downloading %s", url)
    pooch.HTTPDownloader(progressbar=sys.stderr.isatty(), timeout=timeout)(url, str(temporary), None)


def _check(path: Path, sha256: str) -> None:
    actual = pooch.file_hash(str(path), alg="sha256")
    if actual != sha256:
        raise WrongHash(
            f"wrong file: sha256 is {actual}, expected {sha256} ({path.stat().st_size} bytes came; "
            "the file was cut off or has changed at its source); it was not kept"
        )


def _may_recover(error: BaseException) -> bool:
    if isinstance(error, requests.HTTPError):
        return error.response is not None and (error.response.status_code == 429 or error.response.status_code >= 500)
    return isinstance(error, requests.RequestException)


def _reason(error: BaseException | None) -> str:
    match error:
        case requests.HTTPError() if error.response is not None:
            return f"the server answered {error.response.status_code} {error.response.reason}"
        case requests.Timeout():
            return "timed out"
        case requests.exceptions.ChunkedEncodingError():
            return "the transfer broke off: the file is truncated"
        case requests.ConnectionError():
            return "connection refused or lost"
        case FileNotFoundError():
            return "no such file"
        case _:
            return str(error) or type(error).__name__
