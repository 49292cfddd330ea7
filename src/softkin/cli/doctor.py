"""What is installed, which store there is, and which data can be reached: what one looks at when something is amiss."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError
from pathlib import Path
from typing import Any

import yaml

from softkin import __version__
from softkin.cli.store_address import store_address
from softkin.core.config_files import check_config_files
from softkin.core.credentials import with_credentials
from softkin.core.distributions import installed
from softkin.core.errors import ConfigError, StoreError
from softkin.core.urls import without_credentials
from softkin.data import own_files
from softkin.data.reachability import out_of_reach

LIBRARIES = (
    *("snakemake", "mlflow", "numpy", "scipy", "pandas", "pyarrow", "scikit-learn", "xgboost-cpu", "mapie", "crepes"),
    *("optuna", "matplotlib", "typer"),
)
FILES = (Path("config") / "config.yaml", Path("config") / "datasets.yaml")


def diagnosis(folder: Path) -> dict[str, Any]:
    """Versions, the address of the store and the state of each configured dataset; None where there is none.

    Raises:
        ConfigError: a file of the configuration cannot be read, or there is none.
    """
    return {
        "softkin": __version__,
        "python": platform.python_version(),
        "libraries": {name: _version(name) for name in LIBRARIES},
        "store": _store(folder),
        "datasets": _datasets(folder),
    }


def sentences(found: dict[str, Any]) -> list[str]:
    """The same in words."""
    versions = [f"  {name} {version or 'IS MISSING'}" for name, version in found["libraries"].items()]
    data = [f"  {name}: {state}" for name, state in found["datasets"].items()]
    return [
        f"softkin {found['softkin']}, Python {found['python']}",
        *versions,
        f"MLflow store: {found['store'] or 'no run has made one here'}",
        "Data:",
        *data,
    ]


def is_well(found: dict[str, Any]) -> bool:
    """Nothing is missing, and all data can be had."""
    return all(found["libraries"].values()) and not any("out of reach" in one for one in found["datasets"].values())


def _version(name: str) -> str | None:
    try:
        return installed(name)[1]
    except PackageNotFoundError:
        return None


def _store(folder: Path) -> str | None:
    try:
        return without_credentials(store_address(folder))
    except StoreError:
        return None


def _datasets(folder: Path) -> dict[str, str]:
    """What can be had of each configured dataset now."""
    files = [folder / file for file in FILES]
    if not all(file.is_file() for file in files):
        raise ConfigError(
            f"there is no {' or no '.join(map(str, FILES))}", where=folder, fix="run it in the folder of softkin"
        )
    check_config_files(files)
    config: dict[str, Any] = {}
    for file in files:
        config |= yaml.safe_load(file.read_text(encoding="utf-8-sig"))
    mirror = os.environ.get("SOFTKIN_DATA_MIRROR") or config.get("data_mirror")
    retrieved = {name: folder / "results" / name / "raw" for name in config["datasets"]}
    answers = out_of_reach(
        config["datasets"], config["sources"], mirror=mirror and with_credentials(mirror), retrieved=retrieved
    )
    states = {name: "retrieved" if path.exists() else "can be had" for name, path in retrieved.items()}
    gone = {
        name: "its file is not there, out of reach"
        for name in config["datasets"]
        if "urls" not in config["sources"][name] and not own_files.are_there(config["sources"][name], folder)
    }
    return states | gone | {name: f"out of reach: {'; '.join(why)}" for name, why in answers.items()}
