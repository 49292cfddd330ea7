"""Commands of `softkin` that work on a project: each calls what the target of make of the same name calls."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer

from softkin.core.errors import ConfigError

#: As the Makefile sets it: things run side by side, one core each.
ENVIRONMENT = {"OMP_NUM_THREADS": "1", "MLFLOW_DISABLE_TELEMETRY": "true", "PYTHONNOUSERSITE": "1"}

Cores = Annotated[int, typer.Option(min=1, help="jobs at a time")]
In = Annotated[Path, typer.Option("--in", help="folder of the run")]
Files = Annotated[list[str], typer.Argument(help="the robot's file, or files: parts of a row, or trials")]
Name = Annotated[str | None, typer.Option(help="of the dataset; the file's name where left out")]
Join = Annotated[str | None, typer.Option(help="parts belong together by column, time or row")]
Sheet = Annotated[str | None, typer.Option(help="the sheet of a workbook")]
Header = Annotated[str | None, typer.Option(help="the line of the names of columns, from 1, or none")]
Delimiter = Annotated[str | None, typer.Option(help="the character that splits columns")]
Answer = Annotated[int | None, typer.Option(min=1, max=2, help="which of two entries, where a question is asked")]
Notify = Annotated[str | None, typer.Option(help="command that gets the verdict on its standard input")]


def run(
    cores: Cores = 2,
    robot: Annotated[str | None, typer.Option(help="one entry of config/datasets.yaml, and no other")] = None,
    more: Annotated[Path | None, typer.Option(help="a file that overrides the configuration key by key")] = None,
) -> int:
    """The whole pipeline: what is not up to date is made, and nothing else."""
    only = ["--config", f"datasets=[{robot}]"] if robot is not None else []
    return _snakemake("--cores", str(cores), *only, *(["--configfile", str(more)] if more is not None else []))


def demo(cores: Cores = 2) -> int:
    """A first look at everything, in results/demo: one robot, few models, few trials."""
    os.environ.pop("MLFLOW_TRACKING_URI", None)
    return _snakemake("--cores", str(cores), "--directory", "results/demo", "--configfile", "config/demo.yaml")


def robot(
    files: Files,
    name: Name = None,
    join: Join = None,
    sheet: Sheet = None,
    answer: Answer = None,
    cores: Cores = 2,
    few_trials: Annotated[bool, typer.Option("--few-trials", help="a first look, in minutes")] = False,
    yes: Annotated[bool, typer.Option("--yes", help="take the guess as it is, and ask nobody")] = False,
) -> int:
    """One robot of your own and nothing else: guesses its entry, asks, runs it, and says where its model is.

    `new-robot` has more options for files that it cannot read by itself; `run --robot` then goes on.
    """
    from softkin.cli.own_robot import guess_and_run

    _project()
    options = _options(name=name, join=join, sheet=sheet, answer=answer)
    return guess_and_run(files, name, options, _snakemake, cores=cores, few_trials=few_trials, yes=yes)


def new_robot(
    files: Files,
    name: Name = None,
    join: Join = None,
    sheet: Sheet = None,
    header: Header = None,
    delimiter: Delimiter = None,
    answer: Answer = None,
    write: Annotated[bool, typer.Option("--write", help="append the entry to config/datasets.yaml")] = False,
) -> int:
    """Guess the entry of a robot of your own from its files."""
    options = _options(name=name, join=join, sheet=sheet, header=header, delimiter=delimiter, answer=answer)
    return _main("new_robot", *options, *(["--write"] if write else []), "--", *files)


def ui(folder: In = Path(), port: Annotated[int, typer.Option(min=1, max=65535, help="on this machine")] = 5000) -> int:
    """MLflow's UI on the store of the last run, with links to its views."""
    return _main("ui", f"--directory={folder}", f"--port={port}")


def campaign(
    cores: Cores = 2,
    refit: Annotated[bool, typer.Option("--refit", help="redo all; the same numbers must come out")] = False,
    notify: Notify = None,
) -> int:
    """One unattended run with a verdict. Exit code: 0 same or better, 1 failed, 3 worse, 4 ask a person, 75 busy."""
    told = [f"--notify={notify}"] if notify is not None else []
    return _main("campaign", f"--cores={cores}", *(["--refit"] if refit else []), *told)


def verify(folder: In = Path()) -> int:
    """Whether the results are what softkin wrote, and the tables what the stored predictions give."""
    return _main("verify", f"--in={folder}")


def prune(
    keep: Annotated[int, typer.Option(help="how many of the last campaigns stay, at least 1")],
    yes: Annotated[bool, typer.Option("--yes", help="remove, and not only say what")] = False,
) -> int:
    """Remove all campaigns but the last ones from MLflow, and what was superseded before them."""
    return _main("prune", f"--keep={keep}", *(["--yes"] if yes else []))


def schedule(
    at: Annotated[str, typer.Option(help="time of the day")] = "03:17",
    kind: Annotated[str, typer.Option(help="systemd, cron, github or all")] = "all",
    cores: Cores = 2,
    notify: Notify = None,
) -> int:
    """Write what starts a campaign every day, ready to install."""
    told = [f"--notify={notify}"] if notify is not None else []
    return _main("schedule", f"--at={at}", f"--kind={kind}", f"--cores={cores}", *told)


#: Command -> (its name, an example).
COMMANDS: dict[Callable[..., int], tuple[str, str]] = {
    run: ("run", "softkin run --cores 4"),
    demo: ("demo", "softkin demo"),
    robot: ("robot", "softkin robot arm.csv --few-trials"),
    new_robot: ("new-robot", "softkin new-robot commands.csv positions.csv --name arm --write"),
    ui: ("ui", "softkin ui --in results/demo --port 5001"),
    campaign: ("campaign", "softkin campaign --cores 2"),
    verify: ("verify", "softkin verify --in results/demo"),
    prune: ("prune", "softkin prune --keep 50 --yes"),
    schedule: ("schedule", "softkin schedule --at 03:17 --kind systemd"),
}


def add_to(app: typer.Typer, explained: Callable[..., Any]) -> None:
    """Add the commands, each with its example."""
    for command, (name, example) in COMMANDS.items():
        app.command(name, epilog=f"Example: {example}")(explained(command))


def _options(**said: str | int | None) -> list[str]:
    """What was said, as options of a command; what was not is left out."""
    return [f"--{key}={value}" for key, value in said.items() if value is not None]


def _main(module: str, *arguments: str) -> int:
    """The exit code of a command of `softkin.cli`."""
    return int(import_module(f"softkin.cli.{module}").main(arguments))


def _snakemake(*arguments: str) -> int:
    """The exit code of the workflow of this folder."""
    _project()
    return subprocess.call([sys.executable, "-m", "snakemake", *arguments])


def _project() -> None:
    """Raise a ConfigError where this is not the folder of a project."""
    if not Path("Snakefile").is_file():
        raise ConfigError("there is no Snakefile", where=Path.cwd(), fix="run it in the folder of softkin")
