"""Let one process at a time find, write and sweep the runs of a dataset.

Two that do so at once would each see runs that the other has not finished, and delete or double them. A store in a file
has a lock file beside it, which the system frees when its process ends. A server has a registered model of the lock's
name: MLflow refuses a second one of a name, so whoever made it has the lock. That of a process which died is broken at
once on its own machine, elsewhere when its lease has ended.
"""

from __future__ import annotations

import logging
import os
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil
from filelock import FileLock, Timeout
from mlflow import MlflowClient
from mlflow.entities.model_registry import RegisteredModel
from mlflow.exceptions import MlflowException

from softkin.core.addresses import SQLITE
from softkin.core.errors import StoreError
from softkin.tracking.server import check_answers

logger = logging.getLogger("softkin")

#: Seconds after which a lock on a server is that of a process which died: logging a dataset takes a minute.
LEASE = 1800.0
#: Seconds that a process waits for a lock, and between two looks at one on a server.
PATIENCE, PAUSE = 3600.0, 2.0
#: What the names of locks on a server begin with.
PREFIX = "softkin-lock-"
#: Tag of a lock on a server: the process that has it.
PROCESS = "process"


@contextmanager
def locked(tracking_uri: str, name: str, *, patience: float = PATIENCE) -> Iterator[None]:
    """Hold the lock `name` of a store.

    Parameters:
        tracking_uri: where the store is.
        name: what is locked, such as a dataset.
        patience: seconds to wait for another process; 3600 by default.

    Raises:
        StoreError: another process has it all that time.
    """
    guard = _file_lock if tracking_uri.startswith(SQLITE) else _server_lock
    with guard(tracking_uri, name, patience):
        yield


@contextmanager
def _file_lock(tracking_uri: str, name: str, patience: float) -> Iterator[None]:
    file = Path(f"{tracking_uri.removeprefix(SQLITE)}.{name}.lock")
    lock = FileLock(file, timeout=patience)
    try:
        lock.acquire()
    except Timeout as error:
        raise _taken(str(file), patience) from error
    try:
        yield
    finally:
        lock.release()


@contextmanager
def _server_lock(tracking_uri: str, name: str, patience: float) -> Iterator[None]:
    check_answers(tracking_uri)
    client, lock = MlflowClient(tracking_uri, tracking_uri), f"{PREFIX}{name}"
    deadline = time.monotonic() + patience
    while not _made(client, lock):
        _break_if_old(client, lock)
        if time.monotonic() > deadline:
            raise _taken(lock, patience)
        time.sleep(PAUSE)
    try:
        yield
    finally:
        _delete_if(client, lock, lambda there: there.tags.get(PROCESS) == this_process())


def _made(client: MlflowClient, lock: str) -> bool:
    """Whether this process has made the lock; False where it is there."""
    holder = {"holder": f"{socket.gethostname()} {os.getpid()}", PROCESS: this_process()}
    try:
        client.create_registered_model(lock, holder, "A lock of softkin: it goes when logging is done.")
    except MlflowException as error:
        if error.error_code == "RESOURCE_ALREADY_EXISTS":
            return False
        raise
    return True


def _break_if_old(client: MlflowClient, lock: str) -> None:
    """Delete a lock whose lease has ended, or whose process has."""

    def is_old(there: RegisteredModel) -> bool:
        old = time.time() - there.creation_timestamp / 1000 > LEASE or has_ended(there.tags.get(PROCESS, ""))
        if old:
            logger.warning("the lock %s of %s is broken: its process has ended", lock, there.tags.get("holder"))
        return old

    _delete_if(client, lock, is_old)


def _delete_if(client: MlflowClient, lock: str, condition: Callable[[RegisteredModel], bool]) -> None:
    """Delete a lock that is there and meets the condition."""
    try:
        if condition(client.get_registered_model(lock)):
            client.delete_registered_model(lock)
    except MlflowException as error:
        if error.error_code != "RESOURCE_DOES_NOT_EXIST":
            raise


def this_process() -> str:
    """What names this process and no other: where its number counts, the number, and when it started."""
    return f"{_here()} {os.getpid()} {psutil.Process().create_time():.2f}"


def has_ended(process: str) -> bool:
    """Whether a process that `this_process` named has ended; False where its number does not count here."""
    here, number, started = process.rsplit(" ", 2) if process.count(" ") > 1 else ("", "", "")
    if not _here() or here != _here():
        return False
    try:
        there = psutil.Process(int(number))
        return there.status() == psutil.STATUS_ZOMBIE or f"{there.create_time():.2f}" != started
    except psutil.NoSuchProcess:
        return True


def _here() -> str:
    """Names the start of this machine and the space of its processes' numbers; '' where nothing tells them."""
    try:
        boot = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
        return f"{boot} {os.readlink('/proc/self/ns/pid')}"
    except OSError:
        return ""


def _taken(lock: str, patience: float) -> StoreError:
    return StoreError(
        f"another process has logged to the store for {patience:.0f} s", where=lock, fix="wait for it, or end it"
    )
