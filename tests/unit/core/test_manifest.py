from __future__ import annotations

import os
from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.core.files import read_json, with_listed
from softkin.core.manifest import MANIFEST, files_of_runs, write_manifest
from softkin.core.runs import Run

NAMES = ("paper/fit.json", "tuned/fit.json", "tuned/parameters.json")


@pytest.fixture
def manifest(tmp_path: Path) -> Path:
    """Of a model `lr`."""
    folder = tmp_path / "lr"
    for name in NAMES:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    write_manifest(folder / MANIFEST, [folder / name for name in reversed(NAMES)])
    return folder / MANIFEST


def test_it_changes_when_any_file_does_and_not_with_order_folder_or_time(manifest: Path, tmp_path: Path) -> None:
    first = manifest.read_text()
    assert list(read_json(manifest)) == sorted(NAMES)
    moved = manifest.parent.rename(tmp_path / "moved")
    for name in NAMES:
        os.utime(moved / name, (0, 0))
    write_manifest(moved / MANIFEST, [moved / name for name in NAMES])
    assert (moved / MANIFEST).read_text() == first
    for name in NAMES:
        (moved / name).write_text("other")
        write_manifest(moved / MANIFEST, [moved / name for name in NAMES])
        assert (moved / MANIFEST).read_text() != first
        (moved / name).write_text(name)


def test_it_lists_itself_and_the_files_that_it_holds(manifest: Path) -> None:
    listed = list(with_listed([manifest, manifest.parent / "absent.csv"]))
    assert listed[0] == manifest
    assert listed[-1] == manifest.parent / "absent.csv"
    assert len(listed) == 2 + len(read_json(manifest))
    assert all(path.is_file() for path in listed[:-1])


def test_files_are_found_in_the_order_of_the_runs(manifest: Path) -> None:
    files = files_of_runs([manifest], [["lr", "tuned"], ["lr", "paper"]], "fit.json")
    assert list(files.items()) == [
        (Run("lr", "tuned"), manifest.parent / "tuned" / "fit.json"),
        (Run("lr", "paper"), manifest.parent / "paper" / "fit.json"),
    ]
    with pytest.raises(DataError, match=r"paper/parameters\.json is missing"):
        files_of_runs([manifest], [["lr", "paper"]], "parameters.json")
