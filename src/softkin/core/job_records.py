"""Records of what each job wrote: hashes, by which an edited, cut off, swapped or deleted result is noticed.

A job writes one record, so jobs side by side never share a file: `results/logs/fit_model/finger/gp.log` is the log
of the job whose record is `results/manifest/finger/fit_model.gp.json`.
"""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softkin.core.errors import DataError, ResultError
from softkin.core.files import file_sha256, read_json, write_json
from softkin.core.job_params import params_hashes

FOLDER = "manifest"
#: Records of jobs, each with its content; None where it is none.
Records = Iterator[tuple[Path, dict[str, Any] | None]]


@dataclass(frozen=True, slots=True)
class Damage:
    """A file that is not as softkin wrote it: its path, what is wrong (`missing`, `changed`), the output of a rule that
    it belongs to (a folder of figures, say) and the job that wrote it.
    """

    path: Path
    what: str
    output: Path
    job: str


def record_of(log: str | Path) -> Path:
    """The record of the job that has this log."""
    rule, *names = _names_in(log)
    results = Path(log).parents[len(names) + 1]
    return Path(results, FOLDER, *names[:1], ".".join([rule, *names[1:]]) + ".json")


def forget_job(log: str | Path, kept: Iterable[str] = ()) -> None:
    """Take the record of a job away: it is about to write its outputs anew. What it has of the files `kept` stays."""
    files = _recorded(log, kept)
    if files:
        write_json(record_of(log), {"job": " ".join(_names_in(log)), "params": {}, "files": files})
    else:
        record_of(log).unlink(missing_ok=True)


def record_job(
    log: str | Path,
    outputs: Iterable[str | Path],
    params: Mapping[str, Any] | None = None,
    kept: Iterable[str] = (),
) -> None:
    """Write the record of a job that has written its `outputs`, files and folders of files: their hashes, and those of
    its `params`, beside what it had of the files `kept`. Its paths start in the working directory of the run.
    """
    names = _names_in(log)
    folder = Path(log).absolute().parents[len(names) + 1]
    files = _recorded(log, kept)
    for output in (Path(output).absolute() for output in outputs):
        for path in _files_of(output):
            known = {"output": output.relative_to(folder).as_posix(), "sha256": file_sha256(path), **_stamp(path)}
            files[path.relative_to(folder).as_posix()] = known
    write_json(record_of(log), {"job": " ".join(names), "params": params_hashes(params or {}), "files": files})


def recorded_sha256(path: str | Path) -> str | None:
    """The hash (hex) of a result file as a job recorded it; None where no job did."""
    absolute = Path(path).absolute()
    for root in absolute.parents:
        if (root / FOLDER).is_dir():
            name, group = absolute.relative_to(root.parent).as_posix(), absolute.relative_to(root).parts[0]
            for record in [*sorted((root / FOLDER / group).glob("*.json")), *sorted((root / FOLDER).glob("*.json"))]:
                content = read_record(record) or {"files": {}}
                if name in content["files"]:
                    return str(content["files"][name]["sha256"])
            return None
    return None


def load_model(path: str | Path) -> Any:
    """Unpickle a file that a job of this project wrote. Unpickling runs what is in the file, so no other is.

    Raises:
        ResultError: no job has recorded the file, or its content is another.
    """
    content = Path(path).read_bytes()
    check_recorded(path, hashlib.sha256(content).hexdigest(), recorded_sha256(path))
    import joblib

    return joblib.load(io.BytesIO(content))


def check_recorded(path: str | Path, digest: str, recorded: str | None) -> None:
    """Refuse a file that is to be unpickled, unless its hash (hex) is the one that is recorded.

    Raises:
        ResultError: it is another, or no job has recorded the file.
    """
    if digest != recorded:
        what = "changed since softkin wrote it" if recorded else "softkin has no record that it wrote it"
        raise ResultError(
            f"{what}; it is not loaded, since loading runs what is in it",
            where=path,
            fix="delete it and run again",
        )


def damages(results: str | Path, *, thorough: bool, known: Records | None = None) -> Iterator[Damage]:
    """The files below `results` that are not as their jobs recorded them; `known`: its records where they are read.

    `thorough` reads every file. Otherwise those are read whose size or time has changed, and the times of those that
    turn out to be the same are recorded: a project that was moved is read once.
    """
    root = Path(results)
    for record, content in records(root) if known is None else known:
        if content is None:
            continue
        new_times = False
        for name, entry in content["files"].items():
            path = root.parent / name
            what = None
            if not path.is_file():
                # A folder that is gone was removed on purpose, with all that is in it.
                what = "missing" if path.parent.is_dir() else None
            elif thorough or _stamp(path) != {key: entry[key] for key in ("bytes", "mtime_ns")}:
                what = "changed" if file_sha256(path) != entry["sha256"] else None
                if what is None and entry["mtime_ns"] != path.stat().st_mtime_ns:
                    entry["mtime_ns"], new_times = path.stat().st_mtime_ns, True
            if what is not None:
                yield Damage(path, what, root.parent / entry["output"], content["job"])
        if new_times and not thorough:
            write_json(record, content)


def records(results: str | Path) -> Records:
    """Each record of a job below `results`, with its content; None where it is none."""
    for record in sorted(Path(results, FOLDER).rglob("*.json")):
        yield record, read_record(record)


def read_record(record: Path) -> dict[str, Any] | None:
    """The content of a record; None where it is none, which makes what it recorded unknown."""
    try:
        content = read_json(record)
        is_record = isinstance(content["job"], str) and all(
            _is_inside(name, record) and _is_inside(entry["output"], record) and _is_entry(entry)
            for name, entry in content["files"].items()
        )
    except (DataError, OSError, ValueError, TypeError, KeyError, AttributeError):
        return None
    return content if is_record else None


def _is_inside(name: str, record: Path) -> bool:
    """Whether a path leads from the folder of a run into its results, where the record is: into no others."""
    parts = Path(name).parts
    return ".." not in parts and "\0" not in name and parts[:1] == (_results_of(record).name,)


def _results_of(record: Path) -> Path:
    return next(folder.parent for folder in record.absolute().parents if folder.name == FOLDER)


def _is_entry(entry: Mapping[str, Any]) -> bool:
    return isinstance(entry["sha256"], str) and all(isinstance(entry[name], int) for name in ("bytes", "mtime_ns"))


def _names_in(log: str | Path) -> tuple[str, ...]:
    """Rule and wildcards of the job that has this log."""
    parts = Path(log).with_suffix("").parts
    return parts[len(parts) - parts[::-1].index("logs") :]


def _recorded(log: str | Path, names: Iterable[str]) -> dict[str, Any]:
    """What the record of a job has of the files of these names."""
    content = read_record(record_of(log)) or {"files": {}}
    return {name: content["files"][name] for name in names if name in content["files"]}


def _files_of(output: Path) -> list[Path]:
    """A file, or the files of a folder; Snakemake's own, whose names begin with a dot, are none."""
    if output.is_dir():
        return sorted(path for path in output.rglob("*") if path.is_file() and not path.name.startswith("."))
    return [output] if output.exists() else []


def _stamp(path: Path) -> dict[str, int]:
    status = os.stat(path)
    return {"bytes": status.st_size, "mtime_ns": status.st_mtime_ns}
