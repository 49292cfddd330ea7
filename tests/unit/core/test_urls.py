from __future__ import annotations

import pytest

from softkin.core.urls import credentials_in, hide_in, is_loopback, without_credentials


@pytest.mark.parametrize(
    ("url", "shown"),
    [
        ("https://me:s3cret@example.org/a.csv", "https://***@example.org/a.csv"),
        ("https://t0ken@example.org:8443/a.csv", "https://***@example.org:8443/a.csv"),
        ("https://example.org/a.csv?sig=1a2b&x", "https://example.org/a.csv?sig=***&***"),
        ("https://example.org/a.csv#1a2b", "https://example.org/a.csv#***"),
        ("postgresql+psycopg2://me:a@b@db:5432/runs", "postgresql+psycopg2://***@db:5432/runs"),
        ("mssql://me:s3cret@/runs", "mssql://***@/runs"),
        ("https://[me:s3cret@example.org/", "***"),
        ("https://example.org/a.csv", "https://example.org/a.csv"),
        ("sqlite:///mlflow.db", "sqlite:///mlflow.db"),
        ("sqlite:////abs/mlflow.db?key=1", "sqlite:////abs/mlflow.db?key=***"),
        ("sqlite:///mlflow.db?key=1", "sqlite:///mlflow.db?key=***"),
        ("file:///data/robots", "file:///data/robots"),
        ("/data/robots#2/what?.csv", "/data/robots#2/what?.csv"),
        ("results @ night", "results @ night"),
    ],
)
def test_credentials_are_hidden_and_the_rest_stays(url: str, shown: str) -> None:
    assert without_credentials(url) == shown
    assert without_credentials(shown) == shown


def test_credentials_are_hidden_as_they_stand_and_as_they_are_meant() -> None:
    url = "https://me%40work:s%2Fcret@example.org/?sig=a%2Bb#end"
    found = credentials_in(url)
    for secret in ("me%40work", "me@work", "s%2Fcret", "s/cret", "a%2Bb", "a+b", "end"):
        assert secret in found
    text = f"cannot open {url}: s/cret of me@work is wrong"
    assert hide_in(text, url) == f"cannot open {without_credentials(url)}: *** of *** is wrong"
    assert credentials_in("sqlite:///mlflow.db") == []
    assert hide_in("a b c", "https://a:b@example.org") == "a b c"


@pytest.mark.parametrize("url", ["http://localhost:5000", "http://127.0.0.1", "http://127.8.8.8/", "http://[::1]:80/a"])
def test_this_machine_is_known_by_its_names(url: str) -> None:
    assert is_loopback(url)


@pytest.mark.parametrize("url", ["http://localhost.example.org", "http://10.0.0.1", "http://127.0.0.1@a.org", "x"])
def test_other_machines_are_not_this_one(url: str) -> None:
    assert not is_loopback(url)
