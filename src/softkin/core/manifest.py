"""Manifests: one small file that stands for all files of a model's job, as long as each is there and as it was.

Snakemake spends a third of a millisecond on each file that a rule declares as an input, and a dataset's models have 150
files that six rules read. So these rules declare the manifests, and find the files beside them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from softkin.core.errors import DataError
from softkin.core.files import read_json, sha256_of, write_json
from softkin.core.runs import Run

#: Its name, in the folder of a model, whose presets have a folder each.
MANIFEST = "manifest.json"


def write_manifest(manifest: str | Path, files: Iterable[str | Path]) -> None:
    """Write the path of each of `files`, relative to the manifest's folder, and the hash of its content."""
    folder = Path(manifest).parent
    hashes = {Path(file).relative_to(folder).as_posix(): sha256_of([file]) for file in files}
    write_json(manifest, dict(sorted(hashes.items())))


def renew_manifest(manifest: str | Path) -> None:
    """Make a manifest true again: delete it where a file is missing, so that its job runs again; write it anew where
    the content of a file has changed, so that what reads it runs again. No manifest, or a true one, is left alone.
    """
    path = Path(manifest)
    try:
        written = path.stat().st_mtime_ns
        hashes = {path.parent / name: known for name, known in read_json(path).items()}
        newer = [file for file in hashes if file.stat().st_mtime_ns > written]
    except FileNotFoundError:
        path.unlink(missing_ok=True)
        return
    if any(sha256_of([file]) != hashes[file] for file in newer):
        write_manifest(path, hashes)


def files_of_runs(manifests: Iterable[str | Path], runs: Iterable[Sequence[str]], name: str) -> dict[Run, Path]:
    """The file of this name of each of `runs` (model, preset), in their order, by the manifests of their models.

    Raises `DataError` where a manifest does not hold it.
    """
    held = {Path(path).parent.name: (Path(path).parent, read_json(path)) for path in manifests}
    files = {}
    for model, preset in runs:
        folder, hashes = held[model]
        if f"{preset}/{name}" not in hashes:
            raise DataError(
                f"{preset}/{name} is missing", where=folder / MANIFEST, fix="delete this file and run again"
            )
        files[Run(model, preset)] = folder / preset / name
    return files
