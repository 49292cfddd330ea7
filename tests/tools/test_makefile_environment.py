"""make: its targets, and an environment that is of its folder, of the right interpreter, and apart from all others."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import softkin
from tests.conftest import HOUSE
from tests.tools.house_of_programs import house as house
from tests.tools.house_of_programs import made, programs, started


def test_make_alone_lists_every_target_in_a_line(house: Path) -> None:
    done = made(house)
    assert done.returncode == 0, done.stderr
    assert done.stdout == made(house, "help").stdout
    assert started(house) == []
    phony = re.findall(r"^\.PHONY: (.*)", (HOUSE / "Makefile").read_text(), re.MULTILINE)
    lines = [line.split(maxsplit=2) for line in done.stdout.splitlines()]
    assert sorted(name for _, name, _ in lines) == sorted(set(" ".join(phony).split()) - {"always"})
    assert {word for word, _, _ in lines} == {"make"}
    assert {"run": "whole pipeline", "ui": "MLflow's UI"}.items() <= {
        name: text.removeprefix("The ").split(":")[0][:14].split(" on")[0] for _, name, text in lines
    }.items()


def test_an_environment_that_is_up_to_date_is_left_alone(house: Path) -> None:
    for _ in range(2):
        assert made(house, "run").returncode == 0
    assert started(house) == ["snakemake --cores 2"] * 2


def test_a_copy_gets_an_environment_of_its_own(house: Path) -> None:
    """The programs in a copied environment are those of the original, and so is softkin."""
    copy = house.parent / "copy"
    python = programs(house.parent / "system", "3.12.1")
    assert made(house, "run").returncode == 0
    shutil.copytree(house, copy, symlinks=True)
    (copy / "heard.all").unlink()
    done = made(copy, "run", f"PYTHON={python}")
    assert done.returncode == 0, done.stderr
    first, *others = started(copy)
    assert first == "python -m venv .venv"
    assert "pip install" in others[0]
    assert others[-1] == "snakemake --cores 2"
    assert (copy / ".venv" / "of").read_text() == f"{copy.resolve()}\n"
    assert started(house) == ["snakemake --cores 2"]
    assert made(copy, "run").returncode == 0
    assert started(copy)[len(others) + 1 :] == ["snakemake --cores 2"]


def test_a_linked_environment_is_not_touched(house: Path) -> None:
    """It is that of another folder, whose code it runs."""
    (house / ".venv").rename(house.parent / "shared")
    (house / ".venv").symlink_to(house.parent / "shared")
    (house.parent / "shared" / "of").write_text("/elsewhere\n")
    before = sorted(path.name for path in (house.parent / "shared").rglob("*"))
    done = made(house, "run", f"PYTHON={programs(house.parent / 'system', '3.11.7')}")
    assert done.returncode == 0, done.stderr
    assert not (house / ".venv").is_symlink()
    assert sorted(path.name for path in (house.parent / "shared").rglob("*")) == before


def test_another_interpreter_makes_the_environment_anew(house: Path) -> None:
    newer = programs(house.parent / "newer", "3.12.1")
    for _ in range(2):  # the second time it has it
        assert made(house, "run", f"PYTHON={newer}").returncode == 0
    assert started(house).count("python -m venv .venv") == 1
    assert (house / ".venv" / "interpreter").read_text() == "3.12.1 of newer"
    assert made(house, "run").returncode == 0  # and keeps it when none is named
    assert started(house).count("python -m venv .venv") == 1


@pytest.mark.parametrize("version", ["3.10.13", "2.7.18", None])
def test_an_old_interpreter_is_one_sentence_before_anything_is_installed(house: Path, version: str | None) -> None:
    python = programs(house.parent / "old", version) if version else house / "no such python"
    found = version or "none"
    sentence = f'softkin: it needs Python 3.11 or newer, and "{python}" is {found}; name another one'
    for installed in (True, False):
        if not installed:
            (house / ".venv" / "installed").unlink()
        done = made(house, "run", f"PYTHON={python}")
        assert done.returncode == 2
        assert done.stderr.startswith(sentence)
        assert len(done.stderr.splitlines()) == 2  # make's own is the second
        assert started(house) == []
        assert (house / ".venv" / "bin" / "python").exists()


def test_real_interpreters_answer_the_questions_of_the_makefile() -> None:
    text = (HOUSE / "Makefile").read_text()
    asked = dict(re.findall(r"^(ORIGIN|INTERPRETER|VERSION) := (.*)", text, re.MULTILINE))
    answers = {
        name: subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()
        for name, code in asked.items()
    }
    assert answers["ORIGIN"] == str(Path(softkin.__file__).resolve().parents[2])
    assert answers["INTERPRETER"].startswith(sys.version.splitlines()[0])
    assert answers["VERSION"] == ".".join(map(str, sys.version_info[:3]))


def environment_of(house: Path) -> dict[str, str]:
    lines = (house / "heard.environment").read_text().splitlines()
    return dict(line.split("=", 1) for line in lines if "=" in line)


def test_other_packages_do_not_leak_in(house: Path) -> None:
    done = made(house, "run", PYTHONPATH="/opt/ros/humble/lib/python3.10/site-packages", PYTHONHOME="/opt")
    assert done.returncode == 0, done.stderr
    heard_of = environment_of(house)
    assert not {"PYTHONPATH", "PYTHONHOME"} & set(heard_of)
    assert heard_of["PYTHONNOUSERSITE"] == "1"


@pytest.mark.parametrize("home", ["/proc/nobody", ""])
def test_without_a_home_caches_are_kept_here(house: Path, home: str) -> None:
    caches = {"XDG_CACHE_HOME": f"{house}/.venv/cache", "MPLCONFIGDIR": f"{house}/.venv/cache/matplotlib"}
    assert made(house, "run", HOME=home).returncode == 0
    assert caches.items() <= environment_of(house).items()
    assert made(house, "run", HOME=str(house.parent)).returncode == 0
    assert not caches.items() & environment_of(house).items()


SLOW_UNLOCK = '#!/bin/sh\ncase "$1" in --unlock) sleep 0.5;; esac\n'


def test_unlock_comes_before_what_it_is_for(house: Path) -> None:
    slow = (house / ".venv" / "bin" / "snakemake").read_text().replace("#!/bin/sh\n", SLOW_UNLOCK, 1)
    (house / ".venv" / "bin" / "snakemake").write_text(slow)
    assert made(house, "-j4", "run", "unlock", "report").returncode == 0
    assert started(house)[0] == "snakemake --unlock"
    assert len(started(house)) == 3


def test_the_store_is_made_within_a_run(house: Path) -> None:
    """Nothing is removed by a second run, which is refused."""
    (house / "results").mkdir()
    (house / "results" / "mlflow_store.json").write_text("{}")
    (house / ".venv" / "bin" / "snakemake").write_text("#!/bin/sh\nexit 1\n")
    assert made(house, "store").returncode == 2
    assert (house / "results" / "mlflow_store.json").exists()
