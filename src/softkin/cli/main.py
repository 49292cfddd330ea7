"""The command `softkin`: one face of what exists. `softkin --help` lists it; each command has its own --help.

Libraries are imported inside the commands: help and completion come at once.
"""

from __future__ import annotations

import inspect
import json
import os
import sys
from collections.abc import Callable
from enum import StrEnum
from functools import wraps
from pathlib import Path
from typing import Annotated, Any

import typer

from softkin.core.errors import SoftkinError

EXIT_CODES = (
    "Exit codes: 0 as it should be; 1 it failed, or what was asked about is not so; 2 the call or its input is of no "
    "use; 3 `check`: the robot is not where the model says, `inverse`: a target is out of reach, `doctor`: something "
    "is missing; `campaign` has its own."
)
app = typer.Typer(
    help="Data-driven forward kinematics of soft robots, with calibrated intervals.",
    epilog=EXIT_CODES,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


class Form(StrEnum):
    """How a table is written."""

    CSV = "csv"
    PARQUET = "parquet"
    JSON = "json"


class Export(StrEnum):
    """What a model is written as."""

    PYTHON = "python"
    C = "c"
    ONNX = "onnx"


Model = Annotated[Path, typer.Argument(help="calibrated_model.joblib of a finished run")]
Sha256 = Annotated[str | None, typer.Option(help="hash that the model's file must have, if it was taken elsewhere")]
Trust = Annotated[bool, typer.Option("--trust", help="load a model that has no record and no hash: it runs its code")]
Out = Annotated[Form, typer.Option(help="form of the answer")]
To = Annotated[Path | None, typer.Option(help="file that it goes to; standard output where left out")]
AsJson = Annotated[bool, typer.Option("--json", help="answer in JSON")]


def explained(command: Callable[..., int | None]) -> Callable[..., None]:
    """The command with its errors in a sentence on stderr, and its exit code."""

    @wraps(command)
    def run(*arguments: Any, **options: Any) -> None:
        try:
            code = command(*arguments, **options) or 0
        except SoftkinError as error:
            print(f"softkin: {error}", file=sys.stderr)
            code = 2
        except OSError as error:
            print(f"softkin: {error}", file=sys.stderr)
            code = 1
        raise typer.Exit(code)

    return run


def of_a_model(command: Callable[..., int | None]) -> Callable[..., int | None]:
    """The command on a calibrated model with the model's file, its hash, and trust in place of its first parameter."""

    def run(model: Model, sha256: Sha256 = None, trust: Trust = False, **options: Any) -> int | None:
        from softkin.uncertainty.loading import load

        return command(load(model, sha256=sha256, trust=trust), **options)

    (_, *own), (file, *safety) = (
        list(inspect.signature(of, eval_str=True).parameters.values()) for of in (command, run)
    )
    shown = [one.replace(kind=inspect.Parameter.KEYWORD_ONLY) for one in (file, *own, *safety[:2])]
    run.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
    run.__annotations__ = {one.name: one.annotation for one in shown}
    run.__name__, run.__doc__ = command.__name__, command.__doc__
    return run


@app.command(epilog="Example: softkin predict results/finger/calibrated_model.joblib commands.csv --level 0.9")
@explained
@of_a_model
def predict(
    robot: Any,
    commands: Annotated[Path, typer.Argument(help="CSV or Parquet, columns by the robot's own names or u1, u2, ...")],
    level: Annotated[float, typer.Option(help="confidence level of the intervals, in (0, 1)")] = 0.9,
    joint: Annotated[
        bool, typer.Option("--joint", help="bounds that hold all coordinates of a pose at once, not each by itself")
    ] = False,
    out: Out = Form.CSV,
    to: To = None,
    as_json: AsJson = False,
) -> None:
    """Positions (mm, else there is a column `unit`), intervals at commands; `outside`: nothing is promised there."""
    from softkin.cli.use_model import predicted_table, read_rows

    rows, _, unread = read_rows(commands, robot.names, measured=False)
    _say_unread(unread)
    _write(predicted_table(robot, rows, level, joint=joint), Form.JSON if as_json else out, to)


@app.command(epilog="Example: softkin inverse results/finger/calibrated_model.joblib targets.csv --tolerance 2")
@explained
@of_a_model
def inverse(
    robot: Any,
    targets: Annotated[
        Path, typer.Argument(help="CSV or Parquet: where the marker is to be, columns m1_x, m1_y, m1_z")
    ],
    marker: Annotated[int, typer.Option(help="which marker, from 0; -1 is the last")] = -1,
    confidence: Annotated[float, typer.Option(help="confidence level of what is promised, in (0, 1)")] = 0.9,
    tolerance: Annotated[
        float | None, typer.Option(help="adds the probability to be no farther off (mm or own unit)")
    ] = None,
    path: Annotated[bool, typer.Option("--path", help="targets are a path, each reached from the one before")] = False,
    out: Out = Form.CSV,
    to: To = None,
) -> int:
    """Commands that take a marker nearest to targets. Exit code 3: a target is out of reach; its `verdict` says so."""
    from softkin.cli.use_model import command_table, read_targets

    rows, unread = read_targets(targets, robot.names, marker)
    _say_unread(unread)
    table = command_table(robot, rows, marker, confidence, tolerance, path=path)
    _write(table, out, to)
    return 0 if (table["verdict"] == "reachable").all() else 3


@app.command(epilog="Example: softkin suggest results/finger/calibrated_model.joblib --rows 50 --to next.csv")
@explained
@of_a_model
def suggest(
    robot: Any,
    rows: Annotated[int, typer.Option(help="how many commands, the most telling first")] = 50,
    inside: Annotated[
        bool, typer.Option("--inside", help="only commands in-domain, near those of the recording")
    ] = False,
    level: Annotated[float, typer.Option(help="confidence level of the intervals in width_mm, in (0, 1)")] = 0.9,
    seed: Annotated[int, typer.Option(help="another one gives other commands")] = 0,
    out: Out = Form.CSV,
    to: To = None,
) -> None:
    """Commands worth measuring next: between the bounds of the recording, far from all commands that were measured."""
    _write(robot.suggest(rows, inside=inside, confidence=level, seed=seed), out, to)


def _write(table: Any, out: Form, to: Path | None) -> None:
    """The table to a file, or to standard output."""
    from softkin.cli.use_model import finite
    from softkin.core.csv_tables import csv_of

    if out is Form.PARQUET:
        table.to_parquet(to if to is not None else sys.stdout.buffer, index=False)
        return
    if out is Form.JSON:
        records = [{key: finite(value) for key, value in row.items()} for row in table.to_dict(orient="records")]
        text = json.dumps(records, allow_nan=False) + "\n"
    else:
        text = csv_of(table)
    if to is None:
        sys.stdout.write(text)
    else:
        to.write_text(text, encoding="utf-8")


@app.command(epilog="Example: softkin check results/finger/calibrated_model.joblib today.csv")
@explained
@of_a_model
def check(
    robot: Any,
    recording: Annotated[Path, typer.Argument(help="CSV or Parquet: commands and measured positions, as recorded")],
    rate: Annotated[float, typer.Option(help="how often an alarm may be false, however long one watches")] = 0.01,
    as_json: AsJson = False,
) -> int:
    """Whether a robot is where its model says: p-values, the share outside, the alarm. Exit code 3: it is not."""
    from dataclasses import asdict

    from softkin.cli.use_model import check_recording, read_rows

    rows, positions, unread = read_rows(recording, robot.names, measured=True)
    _say_unread(unread)
    assert positions is not None
    found = check_recording(robot, rows, positions, rate)
    print(json.dumps(asdict(found)) if as_json else "\n".join(found.sentences()))
    return 0 if found.alarm_pose is None else 3


@app.command(epilog="Example: softkin export results/finger/calibrated_model.joblib --to robot --level 0.9")
@explained
@of_a_model
def export(
    robot: Any,
    to: Annotated[Path, typer.Option(help="folder that the files go to")] = Path(),
    form: Annotated[list[Export] | None, typer.Option(help="python, c, onnx; the first two where left out")] = None,
    level: Annotated[list[float] | None, typer.Option(help="levels to store; 0.8, 0.9 and 0.95 where left out")] = None,
    name: Annotated[str | None, typer.Option(help="of the files and of what they define; default: the robot's")] = None,
    as_json: AsJson = False,
) -> None:
    """A numpy-only Python file and a C header: position, interval, `outside` and failures, as the model says."""
    from softkin.cli.export_model import remarks, written

    files = written(robot, to, [str(one) for one in form or (Export.PYTHON, Export.C)], level, name)
    for remark in remarks(robot):
        print(f"softkin: {remark}", file=sys.stderr)
    print(json.dumps([str(path) for path in files]) if as_json else "\n".join(map(str, files)))


@app.command(epilog="Example: softkin doctor --json")
@explained
def doctor(as_json: AsJson = False) -> int:
    """What is installed, which store there is, which data can be reached. Exit code 3: something is missing."""
    from softkin.cli.doctor import diagnosis, is_well, sentences

    found = diagnosis(Path())
    print(json.dumps(found) if as_json else "\n".join(sentences(found)))
    return 0 if is_well(found) else 3


def _say_unread(columns: list[str]) -> None:
    if columns:
        print(f"softkin: not read: {', '.join(columns)}", file=sys.stderr)


def main() -> None:
    """Run the command."""
    from softkin.cli import project_commands

    os.environ.update(project_commands.ENVIRONMENT)
    project_commands.add_to(app, explained)
    app(prog_name="softkin")


if __name__ == "__main__":
    main()
