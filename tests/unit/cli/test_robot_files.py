from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli.robot_files import robot_files
from softkin.core.errors import DataError
from softkin.data.readers.file_bundle import is_bundle
from softkin.data.readers.table_formats import open_table


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("trial 1.csv", "trial 2.csv"):
        (tmp_path / name).write_text("u1,x,y,z\n1,2,3,4\n2,3,4,5\n")
    (tmp_path / "take.csv").write_text("m_x,m_y,m_z\n1,2,3\n4,5,6\n")
    return tmp_path


def test_one_file_is_read_where_it_is(folder: Path) -> None:
    with robot_files(["trial 1.csv"], {"header": 1}) as found:
        assert (found.path, found.file, found.options, found.reasons) == (
            Path("trial 1.csv"),
            "trial 1.csv",
            {"header": 1},
            [],
        )
        assert found.entry({"file": "a", "split": {}}) == {"file": "a", "split": {}}
    with robot_files([str(folder / "trial 1.csv")], {}) as found:
        assert found.file == "trial 1.csv"


@pytest.mark.parametrize("names", [["trial *.csv"], ["trial 1.csv", "trial 2.csv"]])
def test_files_of_the_same_columns_are_trials(folder: Path, names: list[str]) -> None:
    assert folder
    with robot_files(names, {}) as found:
        assert is_bundle(found.path.read_bytes()[:100])
        assert found.options == {"files": names}
        assert "so trials; each is a session" in found.reasons[0]
        assert found.entry({"file": "", "session": "session"}) == {"session": "session"}
    assert not found.path.exists()


def test_files_of_other_columns_are_parts(folder: Path) -> None:
    assert folder
    with robot_files(["trial 1.csv", "take.csv"], {}) as found:
        assert found.options == {"files": ["trial 1.csv", "take.csv"], "join": {"by": "row"}}
        assert found.file == "trial 1.csv, take.csv"
    with robot_files(["trial 1.csv", "trial 2.csv"], {}, "row") as found:
        assert found.options["join"] == {"by": "row"}


@pytest.mark.parametrize("names", [["gone.csv"], ["take.csv", "gone.csv"], ["g*.csv"], ["."], [""]])
def test_a_file_that_is_not_there_is_named(folder: Path, names: list[str]) -> None:
    assert folder
    with pytest.raises(DataError, match="no such file: ") as raised, robot_files(names, {}):
        raise AssertionError("opened")
    assert raised.value.where == "FILE"


def test_a_file_that_cannot_be_read_is_named(folder: Path) -> None:
    (folder / "take.csv").write_text("1,2\n3,4\n")
    with pytest.raises(DataError, match=r"take.csv, line 1: no header"), robot_files(["trial 1.csv", "take.csv"], {}):
        raise AssertionError("opened")


def test_trials_of_other_columns_and_folders_are_said(folder: Path) -> None:
    (folder / "trial 3.csv").write_text("u1,X,y,z\n1,2,3,4\n")
    with pytest.raises(DataError, match="columns differ"), robot_files(["trial *.csv"], {}) as found:
        open_table(found.path, found.options)
    with pytest.raises(DataError) as raised, robot_files(["."], {}):
        pass
    assert "that is a folder" in str(raised.value.fix)
