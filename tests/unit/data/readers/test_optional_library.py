from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.optional_library import PACKAGES, library
from softkin.data.readers.table_formats import open_table
from tests.conftest import HOUSE


@pytest.mark.parametrize(
    ("name", "content"),
    [("h5py", b"MATLAB 7.3 MAT-file"), ("h5py", b"\x89HDF\r\n"), ("ezc3d", b"\x02\x50" + b"\0" * 510)],
)
def test_what_is_not_installed_is_named_with_what_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, content: bytes
) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    (tmp_path / "arm").write_bytes(content)
    with pytest.raises(DataError, match=f"{name}, which reads it, is not installed") as raised:
        open_table(tmp_path / "arm", {})
    assert f"pip install {PACKAGES[name]}" in str(raised.value)


def test_a_library_that_is_there_is_given() -> None:
    assert library("h5py", "an HDF5 file", "save it otherwise").File


def test_the_extra_has_the_same_versions() -> None:
    extras = tomllib.loads((HOUSE / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    assert sorted(extras["files"]) == sorted(PACKAGES.values())
