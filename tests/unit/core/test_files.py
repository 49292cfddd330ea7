from __future__ import annotations

import contextlib
import os
from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.core.files import read_json, replacing, sha256_of, write_json


def test_a_file_appears_whole_or_not_at_all(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "a.json"
    write_json(path, {"a": 1})
    with contextlib.suppress(KeyboardInterrupt), replacing(path) as temporary:
        temporary.write_text("half")
        raise KeyboardInterrupt
    assert read_json(path) == {"a": 1}
    assert [p.name for p in path.parent.iterdir()] == ["a.json"]


def test_json_refuses_nan_and_keeps_the_old_file(tmp_path: Path) -> None:
    write_json(tmp_path / "a.json", 1)
    with pytest.raises(ValueError, match="JSON"):
        write_json(tmp_path / "a.json", float("nan"))
    assert read_json(tmp_path / "a.json") == 1


def test_a_file_is_on_the_disk_before_it_takes_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[object] = []
    monkeypatch.setattr(os, "fsync", lambda descriptor: order.append(os.path.isdir(f"/proc/self/fd/{descriptor}")))
    replace = os.replace

    def renamed(*paths: Path) -> None:
        order.append("renamed")
        replace(*paths)

    monkeypatch.setattr(os, "replace", renamed)
    write_json(tmp_path / "a.json", 1)
    assert order == [False, "renamed", True]


@pytest.mark.parametrize("text", ["", '{"a": [1,', "{}{}", '{"a": 1, "a": 2}'])
def test_a_damaged_result_is_named_with_what_to_do(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(DataError, match=r"a\.json: this result is damaged") as error:
        read_json(tmp_path / "a.json")
    assert "delete the file and run again" in str(error.value)


def test_the_hash_knows_where_one_file_ends(tmp_path: Path) -> None:
    (tmp_path / "one").write_text("ab")
    (tmp_path / "two").write_text("c")
    before = sha256_of([tmp_path / "one", tmp_path / "two"])
    (tmp_path / "one").write_text("a")
    (tmp_path / "two").write_text("bc")
    assert sha256_of([tmp_path / "one", tmp_path / "two"]) != before
