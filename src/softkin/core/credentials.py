"""Credentials in the URLs of a configuration: hidden there before anything sees them, looked up where a URL is opened.

Snakemake writes the configuration and the params of jobs to files. So the shown URLs stand there, and the URLs
themselves in an environment variable, which jobs inherit.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any

from softkin.core.errors import ConfigError
from softkin.core.urls import hide_in, without_credentials

#: Environment variable: the URLs that have credentials, by how they are shown (JSON).
KEPT = "SOFTKIN_CREDENTIALS"
#: Environment variables that hold a URL.
VARIABLES = ("MLFLOW_TRACKING_URI", "SOFTKIN_DATA_MIRROR")


def hide_credentials(config: dict[str, Any]) -> None:
    """Replace each URL of `config` (`tracking_uri`, `data_mirror`, `urls` of the sources) by how it is shown. Keep
    those that have credentials, and `VARIABLES`, for `with_credentials` in this process and those that it starts.

    Raises:
        ConfigError: two URLs differ in their credentials alone.
    """
    kept: dict[str, str] = {}
    for holder, key in _places(config):
        url = holder[key]
        shown = without_credentials(url)
        if kept.setdefault(shown, url) != url:
            raise ConfigError(
                f"two URLs {shown} that differ in their credentials alone",
                where="configuration",
                fix="use the same credentials for both",
            )
        if holder is not os.environ:
            holder[key] = shown
    kept = {shown: url for shown, url in kept.items() if shown != url}
    if kept:
        os.environ[KEPT] = json.dumps(kept)
    else:
        os.environ.pop(KEPT, None)


def with_credentials(shown: str) -> str:
    """The URL that is `shown` so."""
    return _kept().get(shown, shown)


def hide_known(text: str) -> str:
    """The `text` without the credentials of the configuration."""
    return hide_in(text, *_kept().values())


def _kept() -> dict[str, str]:
    kept: dict[str, str] = json.loads(os.environ.get(KEPT, "{}"))
    return kept


def _places(config: dict[str, Any]) -> Iterator[tuple[Any, Any]]:
    """(what holds it, key) of each string that is a URL; `config` is not checked yet, and may be anything."""
    yield from ((config, key) for key in ("tracking_uri", "data_mirror") if isinstance(config.get(key), str))
    sources = config.get("sources")
    for entry in sources.values() if isinstance(sources, dict) else ():
        urls = entry.get("urls") if isinstance(entry, dict) else None
        if isinstance(urls, list):
            yield from ((urls, place) for place, url in enumerate(urls) if isinstance(url, str))
    yield from ((os.environ, name) for name in VARIABLES if name in os.environ)
