"""Ask whether a tracking server answers, before MLflow does, which asks for four minutes."""

from __future__ import annotations

import time

import requests

from softkin.core.errors import StoreError
from softkin.core.urls import without_credentials

SCHEMES = ("http://", "https://")
#: Seconds that a server is waited for: it may be starting.
PATIENCE = 10.0
#: What a proxy answers in the place of a server that does not.
AWAY = (502, 503, 504)
#: What libraries say of a connection -> in words.
SAID = {
    "refused": "nothing listens there",
    "resolve": "nobody knows that name",
    "resolution": "nobody knows that name",
}


def check_answers(tracking_uri: str, patience: float = PATIENCE) -> None:
    """See that a tracking server answers, whatever it says; other stores are not asked.

    Parameters:
        tracking_uri: where the store is.
        patience: seconds to wait; 10 by default.

    Raises:
        StoreError: it does not.
    """
    if not tracking_uri.startswith(SCHEMES):
        return
    until = time.monotonic() + patience
    while reason := _reason(f"{tracking_uri.rstrip('/')}/health", max(until - time.monotonic(), 0.1)):
        if time.monotonic() + 0.5 >= until:
            raise StoreError(
                f"the tracking server does not answer: {reason}",
                where=without_credentials(tracking_uri),
                fix="start it, or name another store in `tracking_uri` or MLFLOW_TRACKING_URI; results are kept",
            )
        time.sleep(0.5)


def _reason(url: str, seconds: float) -> str:
    """Why nobody answers there; empty where somebody does."""
    try:
        with requests.get(url, timeout=seconds, stream=True, allow_redirects=False) as answer:
            return f"a proxy says {answer.status_code} in its place" if answer.status_code in AWAY else ""
    except requests.exceptions.SSLError:  # it is there; what MLflow takes for a certificate is its own business
        return ""
    except requests.Timeout:
        return "it says nothing"
    except requests.ConnectionError as error:
        return next((words for part, words in SAID.items() if part in str(error)), "the connection breaks off")
