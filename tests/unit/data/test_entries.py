from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from softkin.data.entries import EXPERIMENTS, OWN_FOLDERS, RESERVED, problems_of_entries
from softkin.tracking import champion, nights
from tests.conftest import HOUSE

SOURCES = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]
OWN: dict[str, Any] = {"title": "Arm", "format": "table_file", "file": "arm.csv", "position_unit": "mm"}
OWN |= {"commands": ["u1"], "positions": ["x", "y", "z"], "split": {"method": "random"}}


def problems(datasets: list[str], **entries: Any) -> list[str]:
    return problems_of_entries({"datasets": datasets, "sources": SOURCES | entries})


def test_the_shipped_entries_have_no_problem() -> None:
    assert problems(list(SOURCES)) == []


def test_the_file_of_a_robot_is_looked_for_only_where_it_is_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert problems(["finger"], arm=OWN) == []
    assert "there is no file arm.csv" in problems(["arm"], arm=OWN)[0]
    (tmp_path / "arm.csv").touch()
    assert problems(["arm"], arm=OWN) == []


def test_a_pattern_and_a_base_are_accepted() -> None:
    entry = OWN | {"commands": "u[0-9]+", "base": {"origin": [None, 0, -20.5], "axis": [0, 0, -1]}}
    assert problems(["finger"], arm=entry) == []


def test_names_of_softkins_own_folders_are_those_that_the_rules_exclude() -> None:
    """A dataset's files are in results/<name>; `make demo` has a folder of its own there."""
    rules = (HOUSE / "workflow" / "rules" / "groups.smk").read_text()
    assert "(?!(?:{'|'.join(OWN_FOLDERS)})/)" in rules
    assert set(RESERVED) - set(OWN_FOLDERS) == {"demo"}
    assert "results/demo" in (HOUSE / "Makefile").read_text()


def test_experiments_of_softkins_own_are_those_that_tracking_makes() -> None:
    assert set(EXPERIMENTS) == {champion.EXPERIMENT, nights.EXPERIMENT, nights.HISTORY}


def test_all_problems_of_an_entry_are_told() -> None:
    found = problems(["finger"], tables=OWN | {"title": "", "commands": "u[", "n_markers": 4})
    assert [line.partition(": ")[0] for line in found] == [
        "sources.tables",
        "sources.tables.title",
        "sources.tables.commands",
        "sources.tables.n_markers",
    ]


def test_several_files_are_looked_for_one_by_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("u_1.csv", "u_2.csv", "x.csv"):
        (tmp_path / name).write_text("u1,x\n")
    entry = {key: value for key, value in OWN.items() if key != "file"}
    assert problems(["arm"], arm=entry | {"files": ["u_*.csv", {"file": "x.csv"}]}) == []
    missing, unmatched = problems(["arm"], arm=entry | {"files": ["u_*.csv", "y.csv", "v_*.csv"]})
    assert missing.startswith("sources.arm.files.1: there is no file y.csv")
    assert unmatched.startswith("sources.arm.files.2: no file is named like 'v_*.csv'")


@pytest.mark.parametrize(("unit", "says"), [("px", ""), ("inch", "did you mean 'in'?"), ("a b", "such as px")])
def test_a_unit_is_a_length_or_a_word_of_ones_own(unit: str, says: str) -> None:
    found = problems(["finger"], arm=OWN | {"position_unit": unit})
    assert len(found) == bool(says)
    assert all(line.startswith("sources.arm.position_unit: ") and says in line for line in found)
