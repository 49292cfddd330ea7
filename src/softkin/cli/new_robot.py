"""A new robot: inspect its files, guess its entry of config/datasets.yaml, show the guess, and with --write append it.

python -m softkin.cli.new_robot arm.csv --name arm --write
python -m softkin.cli.new_robot commands.csv positions.csv --name arm --write
"""

from __future__ import annotations

import argparse
import logging
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from softkin.cli.datasets_file import append_entry, entry_text, read_key
from softkin.cli.guess_entry import Looked, asked, guess_entry, look
from softkin.cli.guess_questions import Question
from softkin.cli.robot_files import RobotFiles, robot_files
from softkin.core.errors import ConfigError, DataError, SoftkinError
from softkin.data.entries import reason_against_name
from softkin.data.readers import table_file
from softkin.data.readers.joined_tables import JOINS

DATASETS = Path("config") / "datasets.yaml"
CONFIG = Path("config") / "config.yaml"
FEW_TRIALS = Path("config") / "few_trials.yaml"
NAME = re.compile(r"[a-z][a-z0-9_]*")

logger = logging.getLogger("softkin")


class _Once(logging.Filter):
    """Lets each message through once: a file is read for the guess, and again as its entry says."""

    def __init__(self) -> None:
        super().__init__()
        self._shown: set[str] = set()

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether it is new."""
        message = record.getMessage()
        is_new = message not in self._shown
        self._shown.add(message)
        return is_new


def show_and_write(
    files: Sequence[str],
    name: str | None,
    write: bool,
    options: Mapping[str, Any] | None = None,
    answer: int | None = None,
    join: str | None = None,
    is_sure: Callable[[], bool] = lambda: True,
) -> None:
    """Print the entry of the robot in `files`; with `write` append it to config/datasets.yaml, if the person `is_sure`.
    `options` are keys of the entry that say how files are read, `join` how several are joined. Where the table raises
    a question, both entries are printed, unless `answer` (1 or 2) says which.

    Raises:
        DataError: there is no such file, or it cannot be used, or a question has to be answered first.
        ConfigError: the name is none, or is taken, or nobody is sure, or the configuration cannot be appended to.
    """
    with robot_files(files, options or {}, join) as found:
        name = checked_name(name, files[0])
        seen = look(found.path, {"file": found.file, **found.options})
        question = asked(found.path, found.options, seen)
        chosen = 0 if question is None or answer is None else answer - 1
        text, entry = _text(name, (name, chosen), found, seen)
        print(text, end="")
        if question is not None and answer is None:
            _ask(question, _text(name, (f"{name}_2", 1), found, seen)[0], found.file, write)
        subsets = table_file.read(found.path, dataset=name, source=entry)
    print("rows: " + ", ".join(f"{subset} {len(rows)}" for subset, rows in subsets.items()), file=sys.stderr)
    if not write:
        print(
            f"Nothing is written yet: run it again with --write (make: WRITE=1), or copy this to {DATASETS}.",
            file=sys.stderr,
        )
        return
    if not is_sure():
        raise ConfigError(
            "nothing is written, as you said no",
            where=name,
            fix=f"say how the file is to be read, see --help, or copy the entry to {DATASETS} and correct it there",
        )
    datasets = read_key(CONFIG.read_text(encoding="utf-8"), CONFIG, "datasets", list)
    append_entry(DATASETS, name, text)
    print(
        f"Appended to {DATASETS}. It alone is run by:\n\nmake run ROBOT={name}\n\n"
        f"or, for a first look with few trials:\n\nmake run ROBOT={name} MORE={FEW_TRIALS}\n\n"
        f"with the others, where {CONFIG} has:\n\n"
        f"datasets: [{', '.join([*datasets, name])}]\n",
        file=sys.stderr,
    )


def _text(name: str, answered: tuple[str, int], found: RobotFiles, seen: Looked) -> tuple[str, dict[str, Any]]:
    """The entry of the dataset `name` under a key by one answer, `answered`, as text and itself."""
    (key, answer), title = answered, name.replace("_", " ").capitalize()
    guessed, reasons = guess_entry(found.path, title, found.file, found.options, answer, seen)
    entry = found.entry(guessed)
    return entry_text(key, entry, [*found.reasons, *reasons]), entry


def _ask(question: Question, other: str, file: str, write: bool) -> None:
    """Print the second entry of the robot in the file, and the question between the two.

    Raises:
        DataError: one is to be written, and nobody has said which.
    """
    print(other, end="")
    told = "; ".join(f"{place + 1}: {what}" for place, what in enumerate(question.answers))
    print(f"Question: {question.text}\nAnswers: {told} (make new-robot ANSWER=1 or 2)", file=sys.stderr)
    if write:
        raise DataError(
            f"a question is open: {question.text}",
            where=file,
            fix="run it again with --answer 1 or 2 (make new-robot ANSWER=1)",
        )


def confirmed() -> bool:
    """Whether the person at the terminal says that the entry is right.

    Raises:
        ConfigError: there is no terminal.
    """
    if not sys.stdin.isatty():
        raise ConfigError("nobody can be asked here", where="standard input", fix="look at the entry, then say --yes")
    print(f"Is this entry right? It is appended to {DATASETS} [y/N] ", end="", file=sys.stderr, flush=True)
    return sys.stdin.readline().strip().lower() in ("y", "yes")


def checked_name(name: str | None, file: str) -> str:
    """The name of the dataset: as it was given, or that of the file."""
    name = re.sub(r"[^a-z0-9]+", "_", Path(file).stem.lower()).strip("_") if name is None else name
    if not NAME.fullmatch(name):
        raise ConfigError(
            f"'{name}' is no name: a letter a-z, then a-z, 0-9, _", where="NAME", fix="choose another with --name"
        )
    if reason := reason_against_name(name):
        raise ConfigError(reason, where="NAME", fix="choose another name with --name")
    return name


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; its exit status is 0, or 2 when the file or the guess is of no use."""
    parser = argparse.ArgumentParser(prog="new_robot", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("files", metavar="FILE", nargs="+", help="the robot's file; or parts of its rows, or trials")
    parser.add_argument("--name", help="name of the dataset; the file's name where left out")
    parser.add_argument("--header", help="the line of the names of columns, from 1, or none")
    parser.add_argument("--delimiter", help="the character that splits columns")
    parser.add_argument("--answer", type=int, choices=(1, 2), help="which of two entries, where a question is asked")
    parser.add_argument("--sheet", help="the sheet of a workbook")
    parser.add_argument("--join", choices=[*JOINS], help="how rows of several files belong together")
    parser.add_argument("--write", action="store_true", help=f"append the entry to {DATASETS}")
    parser.add_argument("--ask", action="store_true", help="ask before it is appended")
    options = parser.parse_args(arguments)
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(levelname)s: %(message)s"))
    handler.addFilter(_Once())
    logger.addHandler(handler)
    logger.setLevel(logging.INFO)
    logger.propagate = False  # each message is shown once, here, whatever handlers the root logger has
    try:
        said = {"delimiter": options.delimiter, "header": options.header, "sheet": options.sheet}
        how: dict[str, Any] = {key: value for key, value in said.items() if value}
        if how.get("header", "").isdecimal():
            how["header"] = int(how["header"])
        is_sure = confirmed if options.ask else lambda: True
        show_and_write(options.files, options.name, options.write, how, options.answer, options.join, is_sure)
    except (SoftkinError, OSError) as error:
        print(f"new_robot: {error}", file=sys.stderr)
        return 2
    finally:
        logger.removeHandler(handler)
        logger.propagate = True
    return 0


if __name__ == "__main__":
    sys.exit(main())
