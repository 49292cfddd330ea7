"""Libraries that few robots need, and that are installed by those who do."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from softkin.core.errors import DataError

#: Library -> what is installed for it; the same versions as in the extra `files` of pyproject.toml.
PACKAGES = {"h5py": "h5py==3.16.0", "ezc3d": "ezc3d==1.7.2"}


def library(name: str, file: str, otherwise: str) -> Any:
    """The library of that name, one of `PACKAGES`.

    Parameters:
        name: of the library.
        file: what kind of file it reads, as in "a C3D file".
        otherwise: how to do without it.

    Raises:
        DataError: it is not installed.
    """
    try:
        return import_module(name)
    except ModuleNotFoundError as error:
        raise DataError(
            f"{file}, and {name}, which reads it, is not installed",
            fix=f"install it: .venv/bin/pip install {PACKAGES[name]}; or {otherwise}",
        ) from error
