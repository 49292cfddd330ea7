"""Stand-ins for interpreters, which write down what they are told."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.conftest import HOUSE
from tools import other_pythons
from tools.other_pythons import interpreter, main

#: It says its version, makes an environment of itself, and fails at what `fails` beside it names.
PYTHON = """#!/bin/sh
here="$(dirname "$0")"
case "$*" in
-c*) cat "$here/version"; exit;;
"-m venv --clear "*) mkdir -p "$4/bin" && cp "$here"/* "$4/bin/" && cp "$0" "$4/bin/python";;
esac
echo "$*" >> "$HEARD"
! grep -q -- "$2" "$here/fails"
"""


def python(path: Path, version: str, fails: str = "nothing") -> Path:
    path.parent.mkdir(parents=True)
    path.write_text(PYTHON)
    path.chmod(0o755)
    (path.parent / "version").write_text(version)
    (path.parent / "fails").write_text(fails)
    return path


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("HEARD", str(tmp_path / "heard"))
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path / "pyenv"))
    monkeypatch.setenv("PATH", f"{tmp_path / 'on the path'}:/usr/bin:/bin")
    (tmp_path / "environment-dev.txt").write_text("hypothesis==6.1\nmypy==2.0\npytest==9.2.0\npytest-timeout==2.4\n")
    return tmp_path


def heard(house: Path) -> list[str]:
    return (house / "heard").read_text().splitlines() if (house / "heard").exists() else []


def test_a_python_that_is_not_there_costs_nothing(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    python(house / "on the path" / "python3.98", "")  # a shim whose version is not chosen
    assert main(["3.98", "3.99"], house) == 0
    said = sorted(capsys.readouterr().out.splitlines())
    assert said == ["Python 3.98 is not on this machine", "Python 3.99 is not on this machine"]
    assert heard(house) == []


def test_one_that_is_there_is_tried(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """By its own environment, behind a shim, too."""
    python(house / "on the path" / "python3.99", "")
    real = python(house / "pyenv" / "versions" / "3.99.1" / "bin" / "python", "3.99")
    assert interpreter("3.99") == real
    assert main(["3.99"], house) == 0
    first, packages, testing, plan, tests = heard(house)
    assert first == f"-m venv --clear {house / '.venv' / 'python3.99'}"
    assert packages.endswith("install --no-compile --requirement environment.txt")
    assert testing.endswith("install --no-compile hypothesis==6.1 pytest==9.2.0 pytest-timeout==2.4")
    assert plan.startswith("-m snakemake --dry-run")
    assert tests.endswith("tests/unit/core")
    assert "Python 3.99 works" in capsys.readouterr().out


def test_one_that_fails_is_named_and_the_others_are_tried(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for version, fails in (("3.98", "snakemake"), ("3.99", "nothing")):
        python(house / "pyenv" / "versions" / f"{version}.0" / "bin" / "python", version, fails)
    assert main(["3.98", "3.99"], house) == 1
    failed, works = sorted(capsys.readouterr().out.splitlines())
    assert failed.startswith("Python 3.98 failed: ")
    assert "-m snakemake --dry-run" in failed
    assert works.startswith("Python 3.99 works")


def test_what_is_run_names_what_the_repository_has() -> None:
    (*_, testing, _, tests) = other_pythons.commands(Path("python"), Path("place"), HOUSE)
    assert [word.split("==")[0] for word in testing if "==" in word] == ["hypothesis", "pytest", "pytest-timeout"]
    assert (HOUSE / tests[-1]).is_dir()
    assert re.search(r"^make .*other-pythons\b", (HOUSE / ".ci" / "run").read_text(), re.MULTILINE)
