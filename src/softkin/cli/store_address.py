"""Say where the MLflow store of a folder is, the one that its last run wrote and none that would be empty, and where
the UI shows it.
"""

from __future__ import annotations

import os
from pathlib import Path

from softkin.core.addresses import is_served
from softkin.core.errors import StoreError
from softkin.core.files import read_json
from softkin.core.urls import HIDDEN, without_credentials

#: Written by the workflow when it has made the store.
STORE = Path("results") / "mlflow_store.json"
VARIABLE = "MLFLOW_TRACKING_URI"
#: Where `make ui` serves a store that no server does.
HOST, PORT = "127.0.0.1", 5000


def store_address(folder: str | Path) -> str:
    """The address of the store that the last run in a folder wrote to.

    Files hold addresses without their credentials; where `MLFLOW_TRACKING_URI` is the same address, it has them.

    Raises:
        StoreError: no run has made one.
    """
    file = Path(folder) / STORE
    if not file.exists():
        raise StoreError("no run has made an MLflow store here", where=file, fix="run the workflow first: make run")
    address = str(read_json(file)["tracking_uri"])
    given = os.environ.get(VARIABLE, "")
    return given if given and without_credentials(given) == address else address


def ui_address(address: str, port: int = PORT) -> str:
    """Where the UI shows the store of an `address`, without credentials: by its server, else on this machine."""
    if not is_served(address):
        return f"http://{HOST}:{port}"
    return without_credentials(address).replace(f"{HIDDEN}@", "").rstrip("/")
