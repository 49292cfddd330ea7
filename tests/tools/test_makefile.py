"""What a person gives to make reaches a program as it is, and is run by neither make nor the shell."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.conftest import HOUSE
from tests.nasty import NASTY
from tests.tools.house_of_programs import house as house
from tests.tools.house_of_programs import made

#: Each would make a file `hit`, or break the recipe, where it is taken for more than text.
VALUES = (
    'it\'s "an" arm; touch hit.csv',
    "$(touch hit)",
    "$(shell touch hit)",
    "${shell touch hit}",
    "`touch hit`",
    "$$(touch hit) $PATH $$ %",
    '"; touch hit; "',
    "a\nb #c \\",
    "-x --write",
    "two  blanks ",  # make drops those before it
    NASTY,
)


def heard(house: Path, target: str, **given: str) -> list[str]:
    """The arguments of the last program that `make target` started, with variables given on its command line."""
    done = made(house, "-s", target, *(f"{name}={value}" for name, value in given.items()))
    assert done.returncode == 0, done.stderr
    assert not list(house.rglob("hit*"))
    return (house / "heard").read_text().split("\0")[:-1]


@pytest.mark.parametrize("value", VALUES)
def test_a_file_may_have_any_name(house: Path, value: str) -> None:
    module = ["-m", "softkin.cli.new_robot"]
    assert heard(house, "new-robot", FILE=value) == [*module, "--", value]
    assert heard(house, "new-robot", FILE="a", NAME=value, WRITE="1") == [
        *module,
        f"--name={value}",
        "--write",
        "--",
        "a",
    ]
    assert heard(house, "new-robot", FILE="a", HEADER=value, DELIMITER=value) == [
        *module,
        f"--header={value}",
        f"--delimiter={value}",
        "--",
        "a",
    ]
    assert heard(house, "new-robot", FILE="a", POSITIONS=value, SHEET=value, JOIN=value) == [
        *module,
        f"--sheet={value}",
        f"--join={value}",
        "--",
        "a",
        value,
    ]
    assert heard(house, "new-robot", FILE="a", WRITE=value) == [*module, "--write", "--", "a"]


@pytest.mark.parametrize("value", VALUES)
def test_every_other_variable_is_text_too(house: Path, value: str) -> None:
    assert heard(house, "run", CORES=value) == ["--cores", value]
    assert heard(house, "run", ROBOT=value) == ["--cores", "2", "--config", f"datasets=[{value}]"]
    module = ["-m", "softkin.cli.ui"]
    assert heard(house, "ui", IN=value, PORT=value) == [*module, f"--directory={value}", f"--port={value}"]
    module = ["-m", "softkin.cli.campaign"]
    assert heard(house, "campaign", NOTIFY=value) == [*module, "--cores=2", f"--notify={value}"]
    schedule = ["-m", "softkin.cli.schedule", f"--at={value}", f"--kind={value}", "--cores=2"]
    assert heard(house, "schedule", AT=value, KIND=value, NOTIFY=value) == [*schedule, f"--notify={value}"]
    assert heard(house, "prune", KEEP=value) == ["-m", "softkin.cli.prune", f"--keep={value}", "--yes"]


def test_variables_of_the_environment_are_text_too(house: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FILE", "$(shell touch hit)$(touch hit)")
    assert heard(house, "new-robot")[-1] == "$(shell touch hit)$(touch hit)"


@pytest.mark.parametrize("value", VALUES)
def test_the_interpreter_is_one_word(house: Path, value: str) -> None:
    """There is none of that name; nothing else is run for it."""
    (house / ".venv" / "installed").unlink()
    assert made(house, f"PYTHON={value}", "run").returncode != 0
    assert not list(house.rglob("hit*"))


def test_no_recipe_has_a_variable_that_a_person_gives() -> None:
    text = (HOUSE / "Makefile").read_text()
    names = next(line for line in text.splitlines() if line.startswith("GIVEN := ")).split()[2:]
    used = set(re.findall(r"\$\$\{?([A-Z_]+)", text)) - {"HOME", "SOFTKIN_DATA_MIRROR"}
    assert {"FILE", "NAME", "CORES", "IN", "WRITE", "HEADER", "DELIMITER"} <= used <= set(names)
    defaults = [line.split("?=")[0].strip() for line in text.splitlines() if "?=" in line]
    assert set(defaults) <= set(names)
    recipes = [line for line in text.splitlines() if line.startswith("\t")]
    assert [line for line in recipes for name in names if f"$({name})" in line or f"${{{name}}}" in line] == []
