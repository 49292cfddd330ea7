"""An MLflow server in a process of its own, that can be stopped and started again."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest


@contextmanager
def sqlite(folder: Path) -> Iterator[str]:
    """URI of a new database."""
    yield f"sqlite:///{folder / 'server.db'}"


@contextmanager
def postgresql(folder: Path) -> Iterator[str]:
    """URI of a new database of a real PostgreSQL, which `make campaigns` installs."""
    process = pytest.importorskip("pgserver").get_server(folder / "postgresql")
    try:
        yield process.get_uri()
    finally:
        process.cleanup()


class Server:
    """A server on a free port that keeps runs in `database` and artifacts in `folder`."""

    def __init__(self, database: str, folder: Path) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.uri, self.folder = f"http://127.0.0.1:{port}", folder
        self.command = [sys.executable, "-m", "mlflow", "server", "--host", "127.0.0.1", "--port", str(port)]
        self.command += ["--workers", "1", "--backend-store-uri", database]
        self.command += ["--artifacts-destination", str(folder / "kept")]
        self.process: subprocess.Popen[bytes] | None = None

    def start(self, seconds: float = 240) -> None:
        """Start it and wait until it answers."""
        environment = os.environ | {"MLFLOW_SERVER_ENABLE_JOB_EXECUTION": "false", "MLFLOW_DISABLE_TELEMETRY": "true"}
        with (self.folder / "server.log").open("a") as log:
            self.process = subprocess.Popen(self.command, env=environment, cwd=self.folder, stdout=log, stderr=log)
        until = time.monotonic() + seconds
        while self.process.poll() is None and time.monotonic() < until:
            try:
                with urllib.request.urlopen(f"{self.uri}/health", timeout=5):
                    return
            except (urllib.error.URLError, OSError):
                time.sleep(0.5)
        raise AssertionError(f"the server is not up, exit status {self.process.poll()}")

    def stop(self) -> None:
        """End it and wait for that."""
        if self.process is not None:
            self.process.terminate()
            self.process.wait(60)


@contextmanager
def serving(database: str, folder: Path) -> Iterator[Server]:
    """A server that runs."""
    server = Server(database, folder)
    try:
        server.start()
        yield server
    finally:
        server.stop()
