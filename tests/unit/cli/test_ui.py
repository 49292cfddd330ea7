from __future__ import annotations

import socket
from pathlib import Path
from typing import Any

import pytest

from softkin.cli import ui
from softkin.core.files import write_json
from tests.unit.stores import new_store


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    address = new_store(tmp_path / "nights.db")
    write_json(tmp_path / "results" / "mlflow_store.json", {"tracking_uri": address})
    return tmp_path


def test_a_busy_port_is_one_sentence(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert ui.main(["--directory", str(folder), "--port", str(port)]) == 1
    assert capsys.readouterr().err == (
        f"softkin: 127.0.0.1: port {port} is in use\n  fix: take another one: make ui PORT={port + 1}\n"
    )


def test_the_store_of_the_last_run_is_served_on_this_machine_alone(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    called: list[Any] = []

    def call(command: list[str], env: dict[str, str]) -> int:
        called.append((command, env))
        return 0

    monkeypatch.setattr("subprocess.call", call)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    assert ui.main(["--directory", str(folder), "--port", str(port)]) == 0
    ((command, environment),) = called
    assert environment["MLFLOW_BACKEND_STORE_URI"] == f"sqlite:///{folder / 'nights.db'}"
    assert command[command.index("--host") + 1] == "127.0.0.1"
    assert environment["MLFLOW_SERVER_ENABLE_JOB_EXECUTION"] == "false"
    assert "Ctrl-C ends it." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("address", "served", "shown"),
    [
        ("postgresql://me:secret@example.org/runs", False, "http://127.0.0.1:7001/#"),
        ("https://me:secret@example.org/mlflow/", True, "https://example.org/mlflow/#"),
    ],
)
def test_a_database_is_served_and_a_server_is_not(
    address: str, served: bool, shown: str, folder: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """And no password is shown, nor stands in a command line."""
    called: list[Any] = []
    monkeypatch.setattr(ui, "store_address", lambda _: address)
    monkeypatch.setattr(ui, "links", lambda _: {"arm": "/#/experiments/1"})

    def call(command: list[str], env: dict[str, str]) -> int:
        called.append((command, env))
        return 0

    monkeypatch.setattr("subprocess.call", call)
    monkeypatch.setattr(ui, "_check_free", lambda _: None)
    assert ui.main(["--directory", str(folder), "--port", "7001"]) == 0
    said = capsys.readouterr().out
    assert f"arm  {shown}" in said
    assert ("is served there already" in said) is served
    assert [env["MLFLOW_BACKEND_STORE_URI"] for _, env in called] == ([] if served else [address])
    assert "secret" not in said + str([command for command, _ in called])


@pytest.mark.parametrize(
    ("where", "says"), [("nowhere", "there is no folder"), (".", "no run has made an MLflow store")]
)
def test_where_there_is_nothing_to_show_it_says_so(
    where: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert ui.main(["--directory", where]) == 1
    assert says in capsys.readouterr().err
