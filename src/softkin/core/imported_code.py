"""The source files that decide what a script writes, read off its imports.

Snakemake sees the inputs of a rule and not the imports of its script, so a hash of the files is a param of the rule;
the fingerprint of a study holds one, too. Sources are read as text and never imported: that takes milliseconds, each
time Snakemake starts.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from softkin.core.files import sha256_of

PACKAGE = Path(__file__).parents[1]

#: Modules that cannot change a result, and why.
WITHOUT_EFFECT = {
    "softkin": "names the public face and the version",
    "softkin.core.clocks": "what a job used",
    "softkin.core.credentials": "keeps credentials out of what is shown",
    "softkin.core.damage": "what is said of a file that is cut off or garbage",
    "softkin.core.durations": "words of the log",
    "softkin.core.errors": "what is said when there is no result",
    "softkin.core.explained": "what is said of errors of libraries",
    "softkin.core.failed_parts": "says on what a job failed",
    "softkin.core.files": "how a file is put in place, whatever it holds",
    "softkin.core.job_params": "notices what was made with other params",
    "softkin.core.job_records": "notices what was not written by softkin",
    "softkin.core.job": "log and record of a job",
    "softkin.core.strict_json": "refuses what is no JSON, and changes nothing",
    "softkin.core.terminal": "how what jobs say stands on the terminal",
    "softkin.core.urls": "what of a URL is shown",
}
#: Modules that a rule uses only where the configuration or a wildcard names them: registries, whose named entries are
#: inputs by themselves, and the cleaning of rows.
CHOSEN_FROM = {
    "softkin.data.audit.cleaning",
    "softkin.data.readers",
    "softkin.models",
    "softkin.models.ensembles",
    "softkin.models.quantile",
    "softkin.uncertainty.intervals",
    "softkin.uncertainty.regions",
}

LEFT_OUT = {*WITHOUT_EFFECT, *CHOSEN_FROM}

_TYPING_ONLY = re.compile(r"^if TYPE_CHECKING:\n(?:(?:[ \t]+.*)?\n)+", re.MULTILINE)
_IMPORT = re.compile(r"^[ \t]*import (softkin(?:\.\w+)*)", re.MULTILINE)
_FROM = re.compile(r"^[ \t]*from (softkin(?:\.\w+)*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)
_COMMENT = re.compile(r"#.*")
_NAME = re.compile(r"(\w+)(?: as \w+)?")


def imported_code(*sources: str | Path) -> list[Path]:
    """The files of softkin that decide what `sources` (scripts or modules) do: all that they import, directly or not,
    also inside functions; those of the package among the sources themselves; sorted.

    Imports for type checkers alone do not count, nor those of `WITHOUT_EFFECT`, nor the entries of `CHOSEN_FROM`.
    """
    files: set[Path] = set()
    waiting = [Path(source).resolve() for source in sources]
    read: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path in read:
            continue
        read.add(path)
        if path.is_relative_to(PACKAGE):
            files.add(path)
        waiting += [file_of(name) for name in imported_modules(path) if name not in LEFT_OUT]
    return sorted(files)


def code_hash(*sources: str | Path) -> str:
    """SHA-256 (hex) of `sources` (scripts or modules) and of all that they import, by names within the package and
    contents: it knows neither the folder that they are in nor their times.
    """
    files = {*(Path(source).resolve() for source in sources), *imported_code(*sources)}
    ordered: list[Path] = sorted(files, key=_name)
    return sha256_of(ordered)


def _name(path: Path) -> str:
    return (path.relative_to(PACKAGE) if path.is_relative_to(PACKAGE) else Path(path.name)).as_posix()


@cache
def imported_modules(path: Path) -> tuple[str, ...]:
    """Dotted names of the modules of softkin that one file imports when it runs, sorted."""
    text = _TYPING_ONLY.sub("", path.read_text(encoding="utf-8"))
    modules = set(_IMPORT.findall(text))
    for module, names in _FROM.findall(text):
        for name in _NAME.findall(_COMMENT.sub("", names)):
            modules.add(f"{module}.{name}" if file_of(f"{module}.{name}").is_file() else module)
    return tuple(sorted(modules))


@cache
def file_of(module: str) -> Path:
    """The source file of a module or package of softkin, by its dotted name."""
    place = PACKAGE.joinpath(*module.split(".")[1:])
    return place / "__init__.py" if place.is_dir() else place.with_suffix(".py")
