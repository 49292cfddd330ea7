from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from softkin.cli import new_robot, project_commands, prune, schedule, ui, verify
from softkin.cli.main import explained


@pytest.fixture
def app() -> typer.Typer:
    made = typer.Typer(rich_markup_mode=None)
    project_commands.add_to(made, explained)
    return made


@pytest.mark.parametrize(
    ("module", "asked", "passed"),
    [
        (new_robot, ["new-robot", "a b.csv", "--name", "arm", "--write"], ["--name=arm", "--write", "--", "a b.csv"]),
        (new_robot, ["new-robot", "a", "--header", "3", "--answer", "2"], ["--header=3", "--answer=2", "--", "a"]),
        (verify, ["verify", "--in", "results/demo"], ["--in=results/demo"]),
        (ui, ["ui", "--port", "5001"], ["--directory=.", "--port=5001"]),
        (prune, ["prune", "--keep", "5"], ["--keep=5"]),
        (schedule, ["schedule", "--kind", "cron"], ["--at=03:17", "--kind=cron", "--cores=2"]),
    ],
)
def test_a_command_calls_what_make_calls(
    app: typer.Typer, module: Any, asked: list[str], passed: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[list[str]] = []

    def called(arguments: list[str]) -> int:
        calls.append(list(arguments))
        return 7

    monkeypatch.setattr(module, "main", called)
    assert CliRunner().invoke(app, asked).exit_code == 7
    assert calls == [passed]


@pytest.mark.parametrize("name", ["run", "demo"])
def test_the_workflow_is_run_where_there_is_one(
    app: typer.Typer, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, [name])
    assert done.exit_code == 2
    assert "there is no Snakefile" in done.stderr
    commands: list[list[str]] = []

    def called(command: list[str]) -> int:
        commands.append(command)
        return 0

    monkeypatch.setattr(subprocess, "call", called)
    (tmp_path / "Snakefile").write_text("")
    assert CliRunner().invoke(app, [name, "--cores", "3"]).exit_code == 0
    assert commands[0][1:5] == ["-m", "snakemake", "--cores", "3"]
    assert ("config/demo.yaml" in commands[0]) == (name == "demo")


def test_every_command_has_an_example_in_its_help(app: typer.Typer) -> None:
    for name, example in project_commands.COMMANDS.values():
        assert f"Example: {example}" in CliRunner().invoke(app, [name, "--help"]).stdout
