"""Retrieve a published file: from the mirror, else from each URL in order; hashed before it is put in place.
A file of one's own is copied, so that a run keeps what it was made from.
"""

from __future__ import annotations

import logging
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from urllib.parse import urlparse

import pooch
import requests
from tenacity import RetryError, Retrying, retry_if_exception, stop_after_attempt, wait_exponential

from softkin.core.errors import SoftkinError
from softkin.core.files import replacing

logger = logging.getLogger("softkin")


class WrongHash(Exception):
    """The bytes that came are not the bytes that were registered."""


def retrieve(
    *,
    dataset: str,
    file: str,
    urls: Sequence[str],
    sha256: str,
    destination: str | Path,
    mirror: str | None = None,
    timeout_seconds: float = 30.0,
    attempts: int = 4,
    backoff_seconds: float = 1.0,
) -> str:
    """Put the registered file of `dataset` at `destination` and return the source it came from.

    Sources are tried in order: `mirror` (a folder, or a URL prefix, that holds `file`), then `urls`. A source that
    may recover (time-out, refused connection, broken transfer, status 429 or 5xx) is tried `attempts` times with
    exponential back-off. Bytes go to a temporary file, are checked against `sha256`, then renamed into place.

    Raises:
        SoftkinError: no source gave the file; names the dataset, what each source answered and the mend.
    """
    complaints = []
    for source, fetch in _sources(file, urls, mirror, timeout_seconds):
        retrying = Retrying(
            stop=stop_after_attempt(attempts),
            wait=wait_exponential(multiplier=backoff_seconds, max=30),
            retry=retry_if_exception(_may_recover),
            before_sleep=lambda state, source=source: logger.warning(  # type: ignore[misc]
                "%s failed (%s); trying again in %.1f s",
                source,
                _reason(state.outcome.exception()),
                state.next_action.sleep,
            ),
        )
        try:
            for attempt in retrying:
                with attempt, replacing(destination) as temporary:
                    fetch(temporary)
                    _check(temporary, sha256)
        except RetryError as error:
            complaints.append(f"{source}: {_reason(error.last_attempt.exception())} ({attempts} attempts)")
        except (WrongHash, OSError) as error:
            complaints.append(f"{source}: {_reason(error)}")
        else:
            logger.info("retrieved %s (%d bytes)", source, Path(destination).stat().st_size)
            return source
        logger.warning("%s", complaints[-1])
    raise SoftkinError(
        f"dataset '{dataset}': no source gave {file}.\n  "
        + "\n  ".join(complaints)
        + f"\n  mend: check the internet connection, or put {file} (sha256 {sha256}) into a folder and name that "
        "folder, or a URL prefix, in SOFTKIN_DATA_MIRROR or in config key data_mirror."
    )


def take_own_file(*, dataset: str, file: str, destination: str | Path, sha256: str | None = None) -> None:
    """Copy the `file` of one's own to `destination`, checked against `sha256` where one is registered.

    Raises:
        SoftkinError: the file is not there or is not the registered one.
    """
    try:
        with replacing(destination) as temporary:
            _copy(Path(file), temporary)
            if sha256 is not None:
                _check(temporary, sha256)
    except (WrongHash, OSError) as error:
        raise SoftkinError(
            f"dataset '{dataset}': {file}: {_reason(error)}\n  mend: correct `file` or `sha256` of its entry in "
            "config/datasets.yaml; a relative path starts where the run works"
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
    found = pooch.file_hash(str(path), alg="sha256")
    if found != sha256:
        raise WrongHash(
            f"wrong file: sha256 is {found}, expected {sha256} ({path.stat().st_size} bytes came; "
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
