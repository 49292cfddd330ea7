"""A new robot: inspect its file, guess its entry of config/datasets.yaml, show the guess, and with --write append it.

python -m softkin.cli.new_robot arm.csv --name arm --write
"""

from __future__ import annotations

import argparse
import logging
import re
import sys
import textwrap
from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from softkin.core.errors import SoftkinError
from softkin.core.files import write_text
from softkin.core.samples import Array
from softkin.data import split
from softkin.data.readers import table_file
from softkin.data.readers.columns import axis_of, marker_by_marker, unit_of

DATASETS = Path("config") / "datasets.yaml"
CONFIG = Path("config") / "config.yaml"
NAME = re.compile(r"[a-z][a-z0-9_]*")
#: Words that tell what a column is; the first kind that has one of a name's words counts.
WORDS = {
    "subset": {"subset", "split"},
    "group": {"group", "trial", "run", "episode", "sequence", "session", "trajectory", "experiment", "repetition"},
    "time": {"t", "time", "timestamp", "stamp", "datetime", "date"},
    "no position": {
        "roll",
        "pitch",
        "yaw",
        "rot",
        "rotation",
        "angle",
        "orientation",
        "euler",
        "vel",
        "velocity",
        "acc",
    },
    "ignored": {"", "index", "idx", "id", "row", "frame", "sample", "n", "no", "qx", "qy", "qz", "qw"},
    "command": {
        *{"u", "p", "q", "cmd", "command", "act", "actuation", "actuator", "input", "pressure", "chamber", "tendon"},
        *{
            "cable",
            "force",
            "tension",
            "motor",
            "torque",
            "voltage",
            "current",
            "servo",
            "valve",
            "setpoint",
            "control",
        },
    },
}
#: A workspace wider than this is taken to be in mm, for want of robots that large.
LARGEST_METRES = 5.0

logger = logging.getLogger("softkin")


def guess_entry(path: Path, title: str, file: str) -> tuple[dict[str, Any], list[str]]:
    """The entry that the table at `path` probably needs, and in words what it was guessed from. `file` is the path that
    is written into it.

    Raises:
        SoftkinError: the file cannot be read, or its columns do not tell which are positions and commands.
    """
    table = table_file.open_table(path)
    positions, dimensions = _positions(table.names)
    kinds = {name: _kind(name) for name in table.names if name not in positions}
    reasons = []
    commands = [name for name, kind in kinds.items() if kind == "command"]
    if not commands:
        commands = [name for name, kind in kinds.items() if kind is None]
        reasons.append("commands: all columns that look like nothing else; please check")
    if not commands:
        raise SoftkinError(
            f"no column looks like a command: {', '.join(table.names[:40])}\n"
            "  mend: name them u1, u2, ..., or write the entry by hand, see config/README.md"
        )
    values, _ = table.read([table.names.index(name) for name in positions], [])
    if not len(values):
        raise SoftkinError("a header, but no row of numbers\n  mend: export the file again")
    unit, why_unit = _unit(positions, values)
    split, why_split = _split(table, kinds)
    entry: dict[str, Any] = {
        "title": title,
        "format": "table_file",
        "file": file,
        "position_unit": unit,
        "commands": commands,
    }
    entry |= {"positions": positions, "split": split}
    reasons += [why_unit, why_split]
    if dimensions == 2:
        entry["dimensions"] = 2
        reasons.append("dimensions: positions of two axes only, so a planar robot")
    left_out = [name for name in table.names if name not in (*commands, *positions, split.get("column"))]
    if left_out:
        reasons.append(f"left out: {', '.join(left_out)}")
    return entry, reasons


def append_entry(path: Path, name: str, text: str) -> None:
    """Append `text`, the YAML of the entry `name`, to the file of datasets at `path`, which keeps its every letter.

    Raises:
        SoftkinError: the name is taken, or the file would not say the same as before plus the entry.
    """
    before = path.read_text(encoding="utf-8")
    after = before.rstrip("\n") + "\n" + text
    entries = _value(before, path, "sources", dict)
    if name in entries:
        raise SoftkinError(f"{path} has an entry '{name}' already\n  mend: choose another name with --name")
    try:
        is_kept = _value(after, path, "sources", dict) == entries | yaml.safe_load(text)
    except SoftkinError:
        is_kept = False
    if not is_kept:
        raise SoftkinError(
            f"{path}: `sources` is not its last key, or its entries are not indented by two\n"
            "  mend: put the shown text under `sources` by hand"
        )
    write_text(path, after)


def _value(text: str, path: Path, key: str, kind: type) -> Any:
    try:
        value = yaml.safe_load(text)[key]
    except (yaml.YAMLError, TypeError, KeyError) as error:
        raise SoftkinError(f"{path}: no YAML with the key `{key}`: {error}\n  mend: correct the file") from error
    if not isinstance(value, kind):
        raise SoftkinError(f"{path}: `{key}` is no {kind.__name__}\n  mend: correct the file")
    return value


def _kind(name: str) -> str | None:
    plain = re.sub(r"[^a-z]+", " ", re.split(r"[\[(]", name.lower())[0]).split()
    return next((kind for kind, known in WORDS.items() if {*plain, "".join(plain)} & known), None)


def _positions(names: Sequence[str]) -> tuple[list[str], int]:
    """Columns of positions, marker by marker, and how many per marker."""
    named = {name: axis for name in names if (axis := axis_of(name)) and _kind(name) != "no position"}
    for axes in ("xyz", *combinations("xyz", 2)):
        found = [
            name for name, (rest, _) in named.items() if sorted(a for r, a in named.values() if r == rest) == [*axes]
        ]
        if found:
            return marker_by_marker([name for name in found if _kind(name) != "command"] or found), len(axes)
    raise SoftkinError(
        f"no columns look like positions: {', '.join(names[:40])}\n"
        "  mend: name them m1_x, m1_y, m1_z, m2_x, ..., or write the entry by hand, see config/README.md"
    )


def _unit(names: Sequence[str], values: Array) -> tuple[str, str]:
    named = {unit_of(name) for name in names}
    if len(named - {None}) > 1:
        raise SoftkinError(f"positions in different units: {', '.join(names)}\n  mend: bring all columns to one unit")
    if None not in named:
        unit = str(named.pop())
        return unit, f"position_unit: the columns' names say {unit}"
    extent = np.ptp(values, axis=0).max()
    unit = "m" if extent <= LARGEST_METRES else "mm"
    return unit, f"position_unit: guessed from the width of the workspace, {extent:.3g}; please check"


def _split(table: table_file.Table, kinds: Mapping[str, str | None]) -> tuple[dict[str, Any], str]:
    by_kind = {kind: name for name, kind in reversed(list(kinds.items()))}
    if name := by_kind.get("subset"):
        _, (column,) = table.read([], [table.names.index(name)])
        if {str(value).strip() for value in column} <= set(split.SPELLINGS):
            return {"method": "column", "column": name}, f"split: '{name}' names the subsets"
    for kind in ("group", "time"):
        if name := by_kind.get(kind):
            return {"method": kind, "column": name}, f"split: by {kind}, since there is a column '{name}'"
    return {"method": "random"}, "split: at random, rows of the same command together"


def _shown(name: str, entry: Mapping[str, Any], reasons: Sequence[str]) -> str:
    """The entry as a part of config/datasets.yaml."""
    text = yaml.safe_dump({name: entry}, sort_keys=False, allow_unicode=True, default_flow_style=None, width=110)
    lines = [f"# {' '.join(reason.split())}" for reason in reasons]
    return textwrap.indent("\n".join([*lines, text]), "  ")


def _run(file: str, name: str | None, write: bool) -> None:
    path = Path(file)
    if not path.is_file():
        raise SoftkinError(
            f"no such file: '{file}'\n  mend: name the robot's CSV or Parquet file: make new-robot FILE=..."
        )
    name = re.sub(r"[^a-z0-9]+", "_", path.stem.lower()).strip("_") if name is None else name
    if not NAME.fullmatch(name):
        raise SoftkinError(f"'{name}' is no name: a letter a-z, then a-z, 0-9, _\n  mend: choose another with --name")
    inside = path.resolve().is_relative_to(Path.cwd())
    listed = path.resolve().relative_to(Path.cwd()).as_posix() if inside else str(path.resolve())
    entry, reasons = guess_entry(path, name.replace("_", " ").capitalize(), listed)
    subsets = table_file.read(path, dataset=name, source=entry)
    text = _shown(name, entry, reasons)
    print(text, end="")
    print("rows: " + ", ".join(f"{subset} {len(rows)}" for subset, rows in subsets.items()), file=sys.stderr)
    if not write:
        print(
            f"Nothing is written yet: run it again with --write (make: WRITE=1), or copy this to {DATASETS}.",
            file=sys.stderr,
        )
        return
    datasets = _value(CONFIG.read_text(encoding="utf-8"), CONFIG, "datasets", list)
    append_entry(DATASETS, name, text)
    print(
        f"Appended to {DATASETS}. In {CONFIG} write:\n\ndatasets: [{', '.join([*datasets, name])}]\n", file=sys.stderr
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; its exit status is 0, or 2 when the file or the guess is of no use."""
    parser = argparse.ArgumentParser(prog="new_robot", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("file", metavar="FILE", help="the robot's CSV or Parquet file")
    parser.add_argument("--name", help="name of the dataset; the file's name where left out")
    parser.add_argument("--write", action="store_true", help=f"append the entry to {DATASETS}")
    options = parser.parse_args(arguments)
    teller = logging.StreamHandler(sys.stderr)
    teller.setFormatter(logging.Formatter("%(levelname)s: %(message)s"))
    logger.addHandler(teller)
    logger.setLevel(logging.INFO)
    logger.propagate = False  # it is told once, here, whatever the process has set up for its root
    try:
        _run(options.file, options.name, options.write)
    except (SoftkinError, OSError) as error:
        print(f"new_robot: {error}", file=sys.stderr)
        return 2
    finally:
        logger.removeHandler(teller)
        logger.propagate = True
    return 0


if __name__ == "__main__":
    sys.exit(main())
