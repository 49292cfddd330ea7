"""A folder with the Makefile whose environment holds programs that write down what they are told."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.conftest import HOUSE

#: A program that writes down its arguments, its environment and each start; as an interpreter it says, asked for it,
#: what the file `of` beside bin holds, where it takes softkin from, or `interpreter`, which one it is.
PROGRAM = """#!/bin/sh
environment="$(dirname "$(dirname "$0")")"
case "$*" in
*find_spec*) cat "$environment/of"; exit;;
*base_prefix*) cat "$environment/interpreter"; exit;;
*version_info*) cat "$environment/version"; grep -q "^3[.]1[1-9]" "$environment/version"; exit;;
"-m venv .venv") mkdir -p .venv && cp -r "$environment/bin" "$environment/interpreter" .venv && pwd -P > .venv/of;;
esac
printf "%s\\0" "$@" > "$HEARD"
env > "$HEARD.environment"
echo "$(basename "$0") $*" >> "$HEARD.all"
"""


def programs(environment: Path, version: str) -> Path:
    """An environment of programs, and its interpreter."""
    (environment / "bin").mkdir(parents=True)
    for name in ("python", "snakemake", "mlflow", "pip"):
        (environment / "bin" / name).write_text(PROGRAM)
        (environment / "bin" / name).chmod(0o755)
    (environment / "version").write_text(version)
    (environment / "interpreter").write_text(f"{version} of {environment.name}")
    return environment / "bin" / "python"


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The Makefile, and an environment of programs."""
    # Under `make test` its own flags and variables are in the environment.
    given = re.search(r"^GIVEN := (.*)$", (HOUSE / "Makefile").read_text(), re.MULTILINE)
    assert given is not None
    for name in (*given[1].split(), "MAKEFLAGS", "MFLAGS", "MAKELEVEL", "MAKEOVERRIDES", "PYTHONNOUSERSITE"):
        monkeypatch.delenv(name, raising=False)
    folder = tmp_path / "a house"
    folder.mkdir()
    shutil.copy(HOUSE / "Makefile", folder)
    for name in ("environment.txt", "pyproject.toml", "environment-dev.txt"):
        (folder / name).touch()
    programs(folder / ".venv", "3.11.7")
    (folder / ".venv" / "of").write_text(f"{folder.resolve()}\n")
    (folder / ".venv" / "installed").touch()
    return folder


def made(house: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """What `make` with these arguments did."""
    given = os.environ | {"HEARD": str(house / "heard")} | environment
    return subprocess.run(["make", *arguments], cwd=house, env=given, capture_output=True, text=True, check=False)


def started(house: Path) -> list[str]:
    """The programs that were started, with their arguments."""
    file = house / "heard.all"
    return file.read_text().splitlines() if file.exists() else []
