from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.core.files import read_json
from softkin.core.manifest import MANIFEST, files_of_runs, renew_manifest, with_listed, write_manifest
from softkin.core.runs import Run

START = time.time()
NAMES = ("paper/fit.json", "tuned/fit.json", "tuned/parameters.json")


@pytest.fixture
def manifest(tmp_path: Path) -> Path:
    """Of a model `lr`, written a second after its files."""
    folder = tmp_path / "lr"
    for name in NAMES:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
        at(folder / name, 0)
    write_manifest(folder / MANIFEST, [folder / name for name in reversed(NAMES)])
    at(folder / MANIFEST, 1)
    return folder / MANIFEST


def at(path: Path, seconds: int) -> None:
    """Give a file a time of modification, counted from the start of the tests."""
    os.utime(path, (START + seconds, START + seconds))


def test_it_changes_when_any_file_does_and_not_with_order_folder_or_time(manifest: Path, tmp_path: Path) -> None:
    first = manifest.read_text()
    assert list(read_json(manifest)) == sorted(NAMES)
    moved = manifest.parent.rename(tmp_path / "moved")
    for name in NAMES:
        at(moved / name, 5)
    write_manifest(moved / MANIFEST, [moved / name for name in NAMES])
    assert (moved / MANIFEST).read_text() == first
    for name in NAMES:
        (moved / name).write_text("other")
        write_manifest(moved / MANIFEST, [moved / name for name in NAMES])
        assert (moved / MANIFEST).read_text() != first
        (moved / name).write_text(name)


def test_a_true_manifest_is_left_alone_though_files_are_newer(manifest: Path) -> None:
    before = manifest.stat().st_mtime_ns
    renew_manifest(manifest)
    at(manifest.parent / NAMES[1], 5)
    renew_manifest(manifest)
    assert manifest.stat().st_mtime_ns == before


def test_it_is_deleted_where_a_file_is_missing(manifest: Path) -> None:
    (manifest.parent / NAMES[1]).unlink()
    renew_manifest(manifest)
    assert not manifest.exists()
    renew_manifest(manifest)  # nothing to do where there is none


def test_it_is_deleted_where_it_is_damaged(manifest: Path) -> None:
    manifest.write_text(manifest.read_text()[:30])
    renew_manifest(manifest)
    assert not manifest.exists()


def test_it_lists_itself_and_the_files_that_it_holds(manifest: Path) -> None:
    listed = list(with_listed([manifest, manifest.parent / "absent.csv"]))
    assert listed[0] == manifest
    assert listed[-1] == manifest.parent / "absent.csv"
    assert len(listed) == 2 + len(read_json(manifest))
    assert all(path.is_file() for path in listed[:-1])


def test_it_is_written_anew_where_a_file_has_changed(manifest: Path) -> None:
    before = read_json(manifest)
    (manifest.parent / NAMES[1]).write_text("other")
    at(manifest.parent / NAMES[1], 5)
    renew_manifest(manifest)
    after = read_json(manifest)
    assert {name for name in NAMES if after[name] != before[name]} == {NAMES[1]}


def test_files_are_found_in_the_order_of_the_runs(manifest: Path) -> None:
    files = files_of_runs([manifest], [["lr", "tuned"], ["lr", "paper"]], "fit.json")
    assert list(files.items()) == [
        (Run("lr", "tuned"), manifest.parent / "tuned" / "fit.json"),
        (Run("lr", "paper"), manifest.parent / "paper" / "fit.json"),
    ]
    with pytest.raises(DataError, match=r"paper/parameters\.json is missing"):
        files_of_runs([manifest], [["lr", "paper"]], "parameters.json")
