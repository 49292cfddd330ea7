"""Manifests: one small file that stands for all files of a job, and changes exactly when one of them does.

Snakemake spends a quarter of a millisecond on each file that a rule declares as an input, and a dataset's models have
150 files that six rules read. So these rules declare the manifests, and find the files beside them. Files that are gone
or were changed since are noticed by the records of their jobs (`core/job_records.py`).
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from softkin.core.errors import DataError
from softkin.core.files import MANIFEST, read_json, sha256_of, write_json
from softkin.core.runs import Run

__all__ = ["MANIFEST", "files_of", "files_of_runs", "write_manifest"]

Name = TypeVar("Name", bound=Hashable)


def write_manifest(manifest: str | Path, files: Iterable[str | Path]) -> None:
    """Write the path of each of `files`, relative to the manifest's folder, and the hash of its content."""
    folder = Path(manifest).parent
    hashes = {Path(file).relative_to(folder).as_posix(): sha256_of([file]) for file in files}
    write_json(manifest, dict(sorted(hashes.items())))


def files_of(manifest: str | Path, names: Mapping[Name, str]) -> dict[Name, Path]:
    """Where the files of these relative paths are, by name and in their order.

    Raises `DataError` where the manifest does not hold one of them.
    """
    folder, held = Path(manifest).parent, read_json(manifest)
    for file in names.values():
        if file not in held:
            raise DataError(f"{file} is missing", where=manifest, fix="delete this file and run again")
    return {name: folder / file for name, file in names.items()}


def files_of_runs(manifests: Iterable[str | Path], runs: Iterable[Sequence[str]], file: str) -> dict[Run, Path]:
    """The file of this name of each of `runs` (model, preset), in their order, by the manifests of their models.

    Raises `DataError` where a manifest does not hold it.
    """
    of_model = {Path(manifest).parent.name: manifest for manifest in manifests}
    files: dict[Run, Path] = {}
    for model, preset in runs:
        files |= files_of(of_model[model], {Run(model, preset): f"{preset}/{file}"})
    return files
