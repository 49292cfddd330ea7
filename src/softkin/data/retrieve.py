"""Retrieve the file of a dataset: a published one from the mirror or its URLs, checked by its hash before it is put in
place; one's own is copied, so that a run keeps what it was made from.
"""

from __future__ import annotations

import logging
import shutil
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import url2pathname

from tenacity import RetryError, Retrying, retry_if_exception, stop_after_attempt, wait_exponential

from softkin.core.errors import DataError, RetrievalError
from softkin.core.files import file_sha256, replacing
from softkin.core.urls import without_credentials
from softkin.data.download import CHUNK_BYTES, PATIENT, Patience, Refused, may_recover, opened, reason
from softkin.data.own_files import parts
from softkin.data.readers.file_bundle import write_bundle

logger = logging.getLogger("softkin")


class WrongHash(Exception):
    """The bytes that came are not the bytes that were registered."""


@dataclass(frozen=True, slots=True)
class Source:
    """A place that may have a file: the path or URL, how it is shown, and how its chunks are opened."""

    place: str
    shown: str
    opened: Callable[[], AbstractContextManager[Iterator[bytes]]]


def retrieve(
    *,
    dataset: str,
    file: str,
    urls: Sequence[str],
    sha256: str,
    destination: str | Path,
    mirror: str | None = None,
    patience: Patience = PATIENT,
) -> str:
    """Put the registered file of a published dataset in place, and return the source that it came from.

    Sources are tried in order: `mirror`, then `urls`. A source that may recover (time-out, refused connection, broken
    transfer, status 429 or 5xx) is tried several times with exponential back-off. Bytes go to a temporary file, are
    checked against `sha256`, then renamed into place.

    Parameters:
        dataset: name of the dataset.
        file: name of the file, in the mirror and in messages.
        urls: where to download it: https, or http on this machine.
        sha256: of its content, hexadecimal; anything else is refused.
        destination: path to put it at.
        mirror: a folder, its file:// URL, or a URL prefix, that holds `file`; None where there is none.
        patience: limits of time and size, attempts and back-off.

    Raises:
        RetrievalError: no source gave the file; says what each of them answered.
    """

    def put_in_place(chunks: Iterator[bytes]) -> None:
        with replacing(destination) as temporary:
            with temporary.open("wb") as to:
                to.writelines(chunks)
            _check(temporary, sha256)

    source, answers = _first(file, urls, mirror, patience, put_in_place, logging.WARNING)
    if source is not None:
        logger.info("retrieved %s (%d bytes)", source, Path(destination).stat().st_size)
        return source
    raise RetrievalError(
        "\n  ".join([f"no source gave {file}", *answers]),
        where=f"dataset '{dataset}'",
        fix=f"check the internet connection, or put {file} (sha256 {sha256}) into a folder and name that folder, or a "
        "URL prefix, in the variable SOFTKIN_DATA_MIRROR or in the configuration key `data_mirror`",
    )


def why_out_of_reach(*, file: str, urls: Sequence[str], mirror: str | None, patience: Patience = PATIENT) -> list[str]:
    """What each source of a published file answers, where none of them has it now; nothing where one has.

    Sources are opened as `retrieve` opens them, with the same retries, and the first bytes read; nothing is kept.
    """
    source, answers = _first(file, urls, mirror, patience, lambda chunks: next(chunks, None), logging.DEBUG)
    return [] if source is not None else answers or ["its entry names no URL, and there is no mirror"]


def _first(
    file: str,
    urls: Sequence[str],
    mirror: str | None,
    patience: Patience,
    use: Callable[[Iterator[bytes]], object],
    level: int,
) -> tuple[str | None, list[str]]:
    """The first source, as it is shown, that can be opened and whose chunks are of `use`, and what those before it
    answered. Failures are logged at `level`.
    """
    answers: list[str] = []
    ends = time.monotonic() + patience.whole_seconds
    for source in _sources(file, urls, mirror, patience, ends):
        try:
            for attempt in _attempts(source, patience, level):
                with attempt, source.opened() as chunks:
                    use(chunks)
        except RetryError as error:
            why = reason(error.last_attempt.exception(), source.place)
            answers.append(f"{source.shown}: {why} ({patience.attempts} attempts)")
        except (WrongHash, Refused, ValueError, OSError) as error:
            answers.append(f"{source.shown}: {reason(error, source.place)}")
        else:
            return source.shown, answers
        logger.log(level, "%s", answers[-1])
    return None, answers


def _attempts(source: Source, patience: Patience, level: int) -> Retrying:
    return Retrying(
        stop=stop_after_attempt(patience.attempts),
        wait=wait_exponential(multiplier=patience.backoff_seconds, max=30),
        retry=retry_if_exception(may_recover),
        before_sleep=lambda state: logger.log(
            level,
            "%s failed (%s); trying again in %.1f s",
            source.shown,
            reason(state.outcome.exception() if state.outcome else None, source.place),
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
            shutil.copyfile(file, temporary)
            if sha256 is not None:
                _check(temporary, sha256)
    except (WrongHash, OSError) as error:
        raise RetrievalError(
            reason(error, file),
            where=f"dataset '{dataset}', file {file}",
            fix="correct `file` or `sha256` of its entry in config/datasets.yaml; a relative path starts in the "
            "working directory of the run",
        ) from error
    logger.info("copied %s (%d bytes)", file, Path(destination).stat().st_size)


def take_own_files(*, dataset: str, entry: Mapping[str, Any], destination: str | Path) -> None:
    """Copy the files that an entry names under `files` to a bundle at `destination`.

    Raises:
        RetrievalError: a file is not there or cannot be read.
        DataError: a pattern matches no file, or parts have different numbers of trials.
    """
    try:
        found = parts(entry)
        with replacing(destination) as temporary:
            write_bundle(found, temporary)
    except DataError as error:
        raise error.within(f"dataset '{dataset}'") from error
    except OSError as error:
        raise RetrievalError(
            reason(error, str(error.filename)),
            where=f"dataset '{dataset}', file {error.filename}",
            fix="correct `files` of its entry in config/datasets.yaml; a relative path starts in the working directory "
            "of the run",
        ) from error
    names = ", ".join(file for files in found for file in files)
    logger.info("copied %s (%d bytes)", names, Path(destination).stat().st_size)


def _sources(file: str, urls: Sequence[str], mirror: str | None, patience: Patience, ends: float) -> Iterator[Source]:
    if mirror and urlsplit(mirror).scheme in ("http", "https"):
        urls = [f"{mirror.rstrip('/')}/{file}", *urls]
    elif mirror:
        path = folder_of(mirror) / file
        yield Source(str(path), f"mirror {path}", lambda: _opened_file(path))
    for url in urls:
        yield Source(url, without_credentials(url), lambda url=url: opened(url, patience, ends))  # type: ignore[misc]


def folder_of(mirror: str) -> Path:
    """The folder that a `mirror` is, given as its path or as a file:// URL."""
    return Path(url2pathname(urlsplit(mirror).path) if mirror.startswith("file://") else mirror)


@contextmanager
def _opened_file(path: Path) -> Iterator[Iterator[bytes]]:
    with path.open("rb") as file:
        yield iter(lambda: file.read(CHUNK_BYTES), b"")


def _check(path: Path, sha256: str) -> None:
    actual = file_sha256(path)
    if actual != sha256:
        raise WrongHash(
            f"wrong file: sha256 is {actual}, expected {sha256} ({path.stat().st_size} bytes came; "
            "the file was cut off or has changed at its source); it was not kept"
        )
