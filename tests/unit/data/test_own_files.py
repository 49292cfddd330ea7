from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.data.own_files import are_there, in_words, listed, matching, named, parts


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("trial_1.csv", "trial_10.csv", "trial_2.csv", "tip_1.csv", "a[1].csv", "a1.csv"):
        (tmp_path / name).write_text("u1,x\n")
    (tmp_path / "trial_3.csv").mkdir()
    return tmp_path


def test_patterns_match_files_in_the_order_of_their_numbers(folder: Path) -> None:
    assert matching("trial_*.csv") == ["trial_1.csv", "trial_2.csv", "trial_10.csv"]
    assert matching("a[1].csv") == ["a[1].csv"], "a file of that very name"
    assert matching("b*.csv") == []
    assert matching("gone.csv") == ["gone.csv"]
    assert are_there({"files": ["trial_*.csv", "tip_1.csv"]}, folder)
    assert not are_there({"files": ["b*.csv"]}, folder)
    assert not are_there({"file": "gone.csv"}, folder)


def test_one_file_is_no_pattern(folder: Path) -> None:
    assert folder
    assert (named({"file": "a*.csv"}), listed({"file": "a*.csv"}), parts({"file": "a*.csv"})) == (
        ["a*.csv"],
        ["a*.csv"],
        [["a*.csv"]],
    )


def test_items_are_parts_with_a_join_and_trials_without(folder: Path) -> None:
    assert folder
    entry = {"files": ["trial_*.csv", {"file": "tip_1.csv", "delimiter": ";"}]}
    assert in_words(entry) == "trial_*.csv, tip_1.csv"
    assert parts(entry) == [["trial_1.csv", "trial_2.csv", "trial_10.csv"], ["tip_1.csv"]]
    assert listed({"files": ["tip_*.csv", "b*.csv"]}) == ["tip_1.csv", "b*.csv"]
    with pytest.raises(DataError, match=r"3 of trial_\*.csv, 1 of tip_1.csv"):
        parts(entry | {"join": {"by": "row"}})
    with pytest.raises(DataError, match=r"no file is named like 'b\*.csv'"):
        parts({"files": ["b*.csv"]})
