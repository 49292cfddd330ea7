from __future__ import annotations

import os
from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.file_bundle import Unpacked, is_bundle, write_bundle


def test_files_come_back_to_the_bit_with_their_names_and_go_with_what_holds_them(tmp_path: Path) -> None:
    for name in ("u.csv", "x y.csv"):
        (tmp_path / name).write_bytes(name.encode() + b"\0\r\n")
    names = [[str(tmp_path / "u.csv")], [str(tmp_path / "x y.csv")]]
    write_bundle(names, tmp_path / "raw")
    assert is_bundle((tmp_path / "raw").read_bytes()[:100])
    unpacked = Unpacked(tmp_path / "raw")
    assert [[name for name, _ in part] for part in unpacked.parts] == names
    paths = [path for part in unpacked.parts for _, path in part]
    assert [path.read_bytes() for path in paths] == [b"u.csv\0\r\n", b"x y.csv\0\r\n"]
    del unpacked
    assert not any(path.exists() for path in paths)


def test_the_same_files_give_the_same_bundle(tmp_path: Path) -> None:
    file = tmp_path / "u.csv"
    for number in (1, 2):
        file.write_text("u1,x\n")
        os.utime(file, (number, number))
        write_bundle([[str(file)]], tmp_path / f"raw{number}")
    assert (tmp_path / "raw1").read_bytes() == (tmp_path / "raw2").read_bytes()


def test_a_damaged_bundle_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "u.csv").write_text("u1,x\n")
    write_bundle([[str(tmp_path / "u.csv")]], tmp_path / "raw")
    (tmp_path / "raw").write_bytes((tmp_path / "raw").read_bytes()[:100])
    with pytest.raises(DataError, match="not readable as a bundle"):
        Unpacked(tmp_path / "raw")
