from __future__ import annotations

import os
from typing import Any

import pytest

from softkin.core.credentials import KEPT, hide_credentials, hide_known, with_credentials
from softkin.core.errors import ConfigError


@pytest.fixture(autouse=True)
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """No other test sees what is kept."""
    for name in (KEPT, "MLFLOW_TRACKING_URI", "SOFTKIN_DATA_MIRROR"):
        monkeypatch.setenv(name, "")
        monkeypatch.delenv(name)


def config() -> dict[str, Any]:
    return {
        "tracking_uri": "postgresql://me:hunter22@db/runs",
        "data_mirror": "https://t0ken@mirror.org/robots",
        "sources": {
            "finger": {"urls": ["https://a.org/FINGER.json?sig=1a2b3c", "https://b.org/FINGER.json"], "notes": "a?b=c"},
            "arm": {"file": "arm?x=1.csv"},
        },
    }


def test_urls_are_hidden_where_they_stand_and_found_where_they_are_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MLFLOW_TRACKING_URI", "http://night:owl99@server:5000")
    hidden = config()
    hide_credentials(hidden)
    assert hidden["tracking_uri"] == "postgresql://***@db/runs"
    assert hidden["data_mirror"] == "https://***@mirror.org/robots"
    assert hidden["sources"]["finger"]["urls"] == ["https://a.org/FINGER.json?sig=***", "https://b.org/FINGER.json"]
    assert hidden["sources"]["arm"] == config()["sources"]["arm"]
    assert os.environ["MLFLOW_TRACKING_URI"] == "http://night:owl99@server:5000"
    assert with_credentials("http://***@server:5000") == "http://night:owl99@server:5000"
    for shown, url in zip(hidden["sources"]["finger"]["urls"], config()["sources"]["finger"]["urls"], strict=True):
        assert with_credentials(shown) == url
    assert hide_known("owl99, hunter22, 1a2b3c and t0ken") == "***, ***, *** and ***"
    again = dict(hidden)
    hide_credentials(again)
    assert again == hidden


def test_without_credentials_nothing_changes() -> None:
    plain = {"tracking_uri": "sqlite:///mlflow.db", "data_mirror": None, "sources": {"arm": {"file": "arm.csv"}}}
    before = dict(plain)
    hide_credentials(plain)
    assert plain == before
    assert KEPT not in os.environ
    assert hide_known("sqlite:///mlflow.db") == "sqlite:///mlflow.db"


@pytest.mark.parametrize("broken", [{}, {"sources": None}, {"sources": {"a": None}}, {"sources": {"a": {"urls": [1]}}}])
def test_a_configuration_that_is_wrong_is_left_to_its_check(broken: dict[str, Any]) -> None:
    hide_credentials(broken)


def test_urls_that_differ_in_their_credentials_alone_are_refused() -> None:
    twice = config()
    twice["sources"]["arm"] = {"urls": ["https://a.org/FINGER.json?sig=other"]}
    with pytest.raises(ConfigError, match="differ in their credentials alone") as error:
        hide_credentials(twice)
    assert "other" not in str(error.value)
