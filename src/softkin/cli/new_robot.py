"""A new robot: inspect its file, guess its entry of config/datasets.yaml, show the guess, and with --write append it.

python -m softkin.cli.new_robot arm.csv --name arm --write
"""

from __future__ import annotations

import argparse
import logging
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from softkin.cli.datasets_file import append_entry, entry_text, read_key
from softkin.cli.guess_entry import asked, guess_entry
from softkin.cli.guess_questions import Question
from softkin.core.errors import ConfigError, DataError, SoftkinError
from softkin.data.entries import RESERVED
from softkin.data.readers import table_file

DATASETS = Path("config") / "datasets.yaml"
CONFIG = Path("config") / "config.yaml"
NAME = re.compile(r"[a-z][a-z0-9_]*")

logger = logging.getLogger("softkin")


def show_and_write(
    file: str,
    name: str | None,
    write: bool,
    options: Mapping[str, Any] | None = None,
    answer: int | None = None,
) -> None:
    """Print the entry of the robot in `file`; with `write` append it to config/datasets.yaml.
    `options` are keys of the entry that say how the file is read. Where the table raises a question, both entries are
    printed, unless `answer` (1 or 2) says which.

    Raises:
        DataError: there is no such file, or it cannot be used, or a question has to be answered first.
        ConfigError: the name is none, or is taken, or the configuration cannot be appended to.
    """
    path = Path(file)
    if not path.is_file():
        raise DataError(
            f"no such file: '{file}'",
            where="FILE",
            fix="name the robot's CSV or Parquet file: make new-robot FILE=...",
        )
    name = re.sub(r"[^a-z0-9]+", "_", path.stem.lower()).strip("_") if name is None else name
    if not NAME.fullmatch(name):
        raise ConfigError(
            f"'{name}' is no name: a letter a-z, then a-z, 0-9, _", where="NAME", fix="choose another with --name"
        )
    if name in RESERVED:
        raise ConfigError(
            f"results/{name} is a folder of softkin's own", where="NAME", fix="choose another name with --name"
        )
    is_below = path.resolve().is_relative_to(Path.cwd())
    listed = path.resolve().relative_to(Path.cwd()).as_posix() if is_below else str(path.resolve())
    title, question = name.replace("_", " ").capitalize(), asked(path, options)
    chosen = 0 if question is None or answer is None else answer - 1
    entry, reasons = guess_entry(path, title, listed, options, chosen)
    text = entry_text(name, entry, reasons)
    print(text, end="")
    if question is not None and answer is None:
        other, why = guess_entry(path, title, listed, options, 1)
        _ask(question, entry_text(f"{name}_2", other, why), path, write)
    subsets = table_file.read(path, dataset=name, source=entry)
    print("rows: " + ", ".join(f"{subset} {len(rows)}" for subset, rows in subsets.items()), file=sys.stderr)
    if not write:
        print(
            f"Nothing is written yet: run it again with --write (make: WRITE=1), or copy this to {DATASETS}.",
            file=sys.stderr,
        )
        return
    datasets = read_key(CONFIG.read_text(encoding="utf-8"), CONFIG, "datasets", list)
    append_entry(DATASETS, name, text)
    print(
        f"Appended to {DATASETS}. In {CONFIG} write:\n\ndatasets: [{', '.join([*datasets, name])}]\n", file=sys.stderr
    )


def _ask(question: Question, other: str, path: Path, write: bool) -> None:
    """Print the second entry of the robot in the file at `path`, and the question between the two.

    Raises:
        DataError: one is to be written, and nobody has said which.
    """
    print(other, end="")
    told = "; ".join(f"{place + 1}: {what}" for place, what in enumerate(question.answers))
    print(f"Question: {question.text}\nAnswers: {told} (make new-robot ANSWER=1 or 2)", file=sys.stderr)
    if write:
        raise DataError(
            f"a question is open: {question.text}",
            where=path,
            fix="run it again with --answer 1 or 2 (make new-robot ANSWER=1)",
        )


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; its exit status is 0, or 2 when the file or the guess is of no use."""
    parser = argparse.ArgumentParser(prog="new_robot", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("file", metavar="FILE", help="the robot's CSV or Parquet file")
    parser.add_argument("--name", help="name of the dataset; the file's name where left out")
    parser.add_argument("--header", help="the line of the names of columns, from 1, or none")
    parser.add_argument("--delimiter", help="the character that splits columns")
    parser.add_argument("--answer", type=int, choices=(1, 2), help="which of two entries, where a question is asked")
    parser.add_argument("--write", action="store_true", help=f"append the entry to {DATASETS}")
    options = parser.parse_args(arguments)
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(levelname)s: %(message)s"))
    logger.addHandler(handler)
    logger.setLevel(logging.INFO)
    logger.propagate = False  # each message is shown once, here, whatever handlers the root logger has
    try:
        said = {"delimiter": options.delimiter, "header": options.header}
        how = {key: int(value) if value.isdecimal() else value for key, value in said.items() if value}
        show_and_write(options.file, options.name, options.write, how, options.answer)
    except (SoftkinError, OSError) as error:
        print(f"new_robot: {error}", file=sys.stderr)
        return 2
    finally:
        logger.removeHandler(handler)
        logger.propagate = True
    return 0


if __name__ == "__main__":
    sys.exit(main())
