"""Addresses in the configuration: of the MLflow store, of a mirror and of downloads, checked without opening any."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import urlsplit

from softkin.core.urls import without_credentials

#: A database in a file: the path follows.
SQLITE = "sqlite:///"
_SQLITE_MAGIC = b"SQLite format 3\0"
#: Schemes of databases that MLflow takes -> the driver that SQLAlchemy loads where the address names none.
DATABASES = {"postgresql": "psycopg2", "mysql": "MySQLdb", "mssql": "pyodbc"}
SERVERS = ("http", "https")


def is_served(uri: str) -> bool:
    """Whether a server has the MLflow store at `uri`; else MLflow opens a database there itself."""
    return urlsplit(uri).scheme in SERVERS


def problems_of_store(uri: str, key: str = "tracking_uri") -> Iterator[str]:
    """Why the MLflow store at `uri` cannot be opened, as far as its address and its file tell."""
    scheme = urlsplit(uri).scheme if re.match(r"[A-Za-z][\w+.-]*:", uri) else ""
    shown = without_credentials(uri)
    if uri.startswith(SQLITE):
        reason = _reason_against_file(uri.removeprefix(SQLITE))
    elif scheme == "sqlite":
        reason = "has not three slashes; write sqlite:///mlflow.db, with a fourth slash before an absolute path"
    elif scheme in SERVERS:
        reason = "" if _has_host(uri) else "names no server; write it like http://127.0.0.1:5000"
    elif scheme.partition("+")[0] in DATABASES:
        database, _, driver = scheme.partition("+")
        needed = driver or DATABASES[database]
        reason = "" if find_spec(needed) else f"needs the package {needed}, which is not installed in .venv"
    elif scheme in ("", "file"):
        reason = "is a folder or file, which MLflow takes no more; write sqlite:/// and the path of a database"
    else:
        known = ", ".join((f"{SQLITE}...", *(f"{name}://" for name in (*SERVERS, *DATABASES))))
        reason = f"has the unknown scheme '{scheme}'; write one of {known}"
    if reason:
        yield f"{key}: {shown} {reason}"


def problems_of_mirror(mirror: str, key: str = "data_mirror") -> Iterator[str]:
    """Why a mirror, a folder or the beginning of URLs, cannot be one."""
    scheme = mirror.partition("://")[0] if "://" in mirror else ""
    if not mirror.strip():
        yield f"{key}: an empty text; name a folder or a URL prefix, or write null"
    elif scheme and scheme not in (*SERVERS, "file"):
        yield f"{key}: {without_credentials(mirror)} has the unknown scheme '{scheme}'; name a folder, http:// or https://"
    elif scheme in SERVERS and not _has_host(mirror):
        yield f"{key}: {without_credentials(mirror)} names no server"
    elif not scheme and Path(mirror).is_file():
        yield f"{key}: {mirror} is a file; name the folder that holds the datasets' files"


def problems_of_url(url: str, key: str) -> Iterator[str]:
    """Why nothing can be downloaded from a URL, as far as it tells itself."""
    if urlsplit(url).scheme not in SERVERS if _splits(url) else True:
        yield f"{key}: {without_credentials(url)} is no http:// or https:// address"
    elif not _has_host(url) or re.search(r"\s", url):
        yield f"{key}: {without_credentials(url)} names no server, or has a blank in it"


def _splits(url: str) -> bool:
    try:
        urlsplit(url)
    except ValueError:
        return False
    return True


def _has_host(url: str) -> bool:
    try:
        parts = urlsplit(url)
        return bool(parts.hostname) and (parts.port is None or parts.port > 0)
    except ValueError:
        return False


def _reason_against_file(name: str) -> str:
    """Why there can be no SQLite database in the file of that name; empty where there can."""
    if not name or name.startswith(":memory:"):
        return "is kept in memory, where no other job sees it; write sqlite:///mlflow.db"
    path = Path(name.partition("?")[0])
    folder = next((above for above in path.parents if above.exists()), Path())
    if path.is_dir():
        return "is a folder; name a file in it, such as mlflow.db"
    if not folder.is_dir():
        return f"lies below {folder}, which is no folder"
    if not path.parent.is_dir():
        return f"lies in {path.parent}, which is not there; make that folder"
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        return "may not be written; change its permissions or name another file"
    if path.exists():
        try:
            with path.open("rb") as file:
                start = file.read(len(_SQLITE_MAGIC))
        except OSError as error:
            return f"cannot be read: {(error.strerror or str(error)).lower()}"
        if start and start != _SQLITE_MAGIC:
            return "is no SQLite database; name another file, or move this one away"
    return ""
