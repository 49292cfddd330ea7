"""Installed libraries: the distribution that provides one, and its version."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

#: Distributions that provide one and the same library, the one of environment.txt first.
SAME_LIBRARY = (("xgboost-cpu", "xgboost"),)


def installed(name: str) -> tuple[str, str]:
    """(distribution, version) of the library that the distribution `name` provides: its own, or that of another
    distribution of the same library where that is installed in its place.

    Raises:
        PackageNotFoundError: none of them is installed.
    """
    for distribution in next((names for names in SAME_LIBRARY if name in names), ()):
        try:
            return distribution, version(distribution)
        except PackageNotFoundError:
            continue
    return name, version(name)
