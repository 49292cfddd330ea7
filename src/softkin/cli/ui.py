"""Open the MLflow UI on the store of a folder, and print links to what one looks for.

    python -m softkin.cli.ui --port 5000

The links open runs directly: by itself the UI hides them behind *Model training*.
"""

from __future__ import annotations

import argparse
import os
import socket
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from softkin.cli.store_address import HOST, PORT, store_address, ui_address
from softkin.core.addresses import is_served
from softkin.core.errors import ConfigError, SoftkinError
from softkin.tracking.links import links


def main(arguments: Sequence[str] | None = None) -> int:
    """Serve the UI until it is ended; return its exit code."""
    parser = argparse.ArgumentParser(prog="softkin.cli.ui", allow_abbrev=False, description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    parser.add_argument("--port", type=int, default=PORT, help="on this machine; 5000 by default")
    parser.add_argument("--directory", type=Path, default=Path(), help="folder of a run; this one by default")
    asked = parser.parse_args(arguments)
    try:
        os.chdir(asked.directory)  # a store in a file is named from here
        address = store_address(Path())
        for line in page(address, asked.port):
            print(line, flush=True)
        return 0 if is_served(address) else serve(address, asked.port)
    except FileNotFoundError:
        print(f"softkin: there is no folder {asked.directory}", file=sys.stderr)
    except SoftkinError as error:
        print(f"softkin: {error}", file=sys.stderr)
    return 1


def page(address: str, port: int) -> Iterator[str]:
    """The lines that are printed: what is served, and a link to each view.

    Raises:
        StoreError: the store cannot be opened.
        ConfigError: the port is taken.
    """
    if not is_served(address):
        _check_free(port)
    found = links(address)
    width = max(map(len, found), default=0)
    yield "The store is served there already." if is_served(address) else "Ctrl-C ends it."
    for name, path in found.items():
        yield f"  {name:<{width}}  {ui_address(address, port)}{path}"


def serve(address: str, port: int) -> int:
    """Serve the UI of a store that no server has, on this machine alone."""
    # Not as an argument, which every user of the machine can read: a database's address may hold a password.
    environment = os.environ | {"MLFLOW_SERVER_ENABLE_JOB_EXECUTION": "false", "MLFLOW_BACKEND_STORE_URI": address}
    command = [sys.executable, "-m", "mlflow", "ui", "--workers", "1"]
    try:
        return subprocess.call([*command, "--host", HOST, "--port", str(port)], env=environment)
    except KeyboardInterrupt:
        return 0


def _check_free(port: int) -> None:
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError:
            raise ConfigError(
                f"port {port} is in use", where=HOST, fix=f"take another one: make ui PORT={port + 1}"
            ) from None


if __name__ == "__main__":
    sys.exit(main())
