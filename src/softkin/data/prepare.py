"""Prepare a dataset: its retrieved file -> the tidy table in mm, and a description of it."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.errors import DataError, ResultError
from softkin.core.files import file_sha256, write_json
from softkin.core.job_records import recorded_sha256
from softkin.core.samples import CONSTANT_RANGE_MM, TRAIN, Samples, coordinate_columns, informative_coordinates
from softkin.core.units import MM, own_unit, per_unit, unit_in_tables
from softkin.data.marker_order import RELABELLED, relabelled
from softkin.data.orientation import about_mean
from softkin.data.own_files import in_words
from softkin.data.readers import READERS, WITH_NAMES
from softkin.data.readers.columns import ORIENTATION, UNUSED, orientations
from softkin.data.readers.complete_rows import LOST_MARKERS
from softkin.data.recordings import description as recording_description
from softkin.data.recordings import with_order_table
from softkin.data.scored_rows import ALL_ROWS, DRAWN_FROM, KeptRows, scored_rows
from softkin.data.split import check_sizes
from softkin.data.table import content_hash, schema, to_table, write_table

logger = logging.getLogger("softkin")

#: Fewer cannot be split into folds and shells of `train`.
MIN_DISTINCT_COMMANDS = 5
#: Positions that range over less or more than this are probably in another unit than the entry says.
PLAUSIBLE_MM = (1.0, 10_000.0)


Cleaning = Callable[[Mapping[str, Samples]], tuple[dict[str, Samples], dict[str, int]]]


def prepare(
    raw: str | Path,
    *,
    dataset: str,
    source: Mapping[str, Any],
    table: str | Path,
    description: str | Path,
    order_table: str | Path | None = None,
    kept: KeptRows = ALL_ROWS,
    clean: Cleaning | None = None,
) -> None:
    """Read the file of a dataset, check it, write its tidy table (in mm or a unit of one's own) and a description.

    Parameters:
        raw: path of the retrieved file.
        dataset: name of the dataset.
        source: its entry in config/datasets.yaml.
        table: path of the tidy table to write (Parquet).
        description: path of the description to write (JSON).
        order_table: path of the table that says when rows were recorded, where the entry names one.
        kept: how many rows of each subset are kept at most.
        clean: drops rows of `train` and counts them by kind; None drops none.

    Raises:
        DataError: the file is not what its entry says.
        ResultError: the file was changed since it was retrieved.
    """
    sha256 = _checked_hash(raw, source, dataset)
    samples, counts, columns = _read(raw, source, dataset)
    sizes = {subset: len(rows) for subset, rows in samples.items()}
    where = f"dataset '{dataset}', file {in_words(source)}"
    _check_sizes(sizes, source, f"dataset '{dataset}', file {raw}")
    if order_table is not None:
        samples = with_order_table(samples, order_table, source)
    recorded = recording_description(samples)
    samples = {
        subset: _in_unit_of_tables(rows, kept.first, source["position_unit"]) for subset, rows in samples.items()
    }
    if source.get("relabel"):
        samples, counts = _relabelled(samples, counts)
    removed = None
    if clean is not None:
        samples, removed = clean(samples)
        logger.info("cleaned train: %s", ", ".join(f"{count} {what}" for what, count in removed.items()))
    samples, drawn_from = scored_rows(samples, kept)
    _check_left(samples, where)
    _check_movement(samples[TRAIN], unit_in_tables(source["position_unit"]), f"{where}, `train`")
    _warn_of_implausible_range(samples[TRAIN], source, where)
    samples, oriented = about_mean(samples, source)
    write_table(_checked_table(samples), table)
    about: dict[str, Any] = {
        "dataset": dataset,
        "sha256": sha256,
        "removed_from_train": removed,
        "is_cut": kept.first is not None and any(size > kept.first for size in sizes.values()),
    } | ({DRAWN_FROM: drawn_from} if drawn_from else {})
    about |= counts | oriented | _description(samples, source) | ({"recording": recorded} if recorded else {})
    write_json(description, about | _columns(columns, source, counts))
    n_rows, train = sum(map(len, samples.values())), samples[TRAIN]
    logger.info("%d rows, %d commands, %d coordinates", n_rows, train.commands.shape[1], train.positions.shape[1])


def _relabelled(samples: Mapping[str, Samples], counts: Mapping[str, Any]) -> tuple[dict[str, Samples], dict[str, Any]]:
    """The samples with their markers in order, and what was left out beside how many rows that mended."""
    samples, mended = relabelled(samples)
    logger.info("relabelled: %s", ", ".join(f"{count} rows of {subset}" for subset, count in mended.items()))
    return samples, {**counts, RELABELLED: mended}


def _checked_table(samples: Mapping[str, Samples]) -> pd.DataFrame:
    """The tidy table of the samples, as its schema says."""
    frame, train = to_table(samples), samples[TRAIN]
    kept = (train.recording, train.block, train.orientation)
    shape = train.commands.shape[1], train.positions.shape[1] // 3
    schema(*shape, *(part is not None for part in kept)).validate(frame)
    return frame


def _columns(columns: Mapping[str, Any], source: Mapping[str, Any], counts: Mapping[str, Any]) -> dict[str, Any]:
    """What the robot's own file calls the `columns` that are kept, and its unit; which columns are not used, and which
    of these are an orientation. Empty for files without names.
    """
    if not columns:
        return {}
    lost = {name for marker in counts.get(LOST_MARKERS, ()) for name in marker["columns"]}
    kept = [name for name in columns["positions"] if name not in lost]
    unused = columns[UNUSED]
    found = {UNUSED: unused, ORIENTATION: orientations(unused)}
    named = {key: value for key, value in columns.items() if key != UNUSED}
    named |= {"positions": kept, "mm_per_unit": per_unit(source["position_unit"])}
    return {key: names for key, names in found.items() if names} | {"columns": named}


def _description(samples: Mapping[str, Samples], source: Mapping[str, Any]) -> dict[str, Any]:
    """What the samples of a table (mm) and the entry `source` say."""
    train = samples[TRAIN]
    return {
        "title": source["title"],
        "origin": "stand-in" if "robot" in source else "published" if "urls" in source else "own",
        "n_commands": train.commands.shape[1],
        "n_markers": train.positions.shape[1] // 3,
        "rows": {subset: len(rows) for subset, rows in samples.items()},
        "content_sha256": {subset: content_hash(rows) for subset, rows in samples.items()},
        "constant_coordinates": _constant_coordinates(train),
        **own_unit(unit_in_tables(source["position_unit"])),
    }


def _check_left(samples: Mapping[str, Samples], where: str) -> None:
    """Enough rows are left of each subset."""
    try:
        check_sizes({subset: len(rows) for subset, rows in samples.items()})
    except DataError as error:
        raise error.within(where) from error


def _read(
    raw: str | Path, source: Mapping[str, Any], dataset: str
) -> tuple[dict[str, Samples], dict[str, Any], dict[str, Any]]:
    """The samples of the file, what was left out by kind where the entry asks for it, and what its columns are called
    where they have names.
    """
    counts: dict[str, Any] = {}
    columns: dict[str, Any] = {}
    told = {"counts": counts} if {"missing", "join"} & set(source) else {}
    told |= {"own_columns": columns} if source["format"] in WITH_NAMES else {}
    return READERS[source["format"]](raw, dataset=dataset, source=source, **told), counts, columns


def _checked_hash(raw: str | Path, source: Mapping[str, Any], dataset: str) -> str:
    """SHA-256 (hex) of the retrieved file, checked by its entry or, for a file of one's own, by what was recorded."""
    actual = file_sha256(raw)
    expected = source.get("sha256") or recorded_sha256(raw) or actual
    if actual != expected:
        raise ResultError(
            f"its sha256 is {actual}, expected {expected}: it was changed since it was retrieved",
            where=f"dataset '{dataset}', file {raw}",
            fix="delete it and run again",
        )
    return actual


def _check_sizes(sizes: Mapping[str, int], source: Mapping[str, Any], where: str) -> None:
    for subset, registered in source.get("rows", {}).items():
        if sizes[subset] != registered:
            raise DataError(
                f"{sizes[subset]} rows, but the entry registers {registered}",
                where=f"{where}, subset {subset}",
                fix="correct `rows` of the entry in config/datasets.yaml, or the file",
            )


def _check_movement(train: Samples, unit: str, where: str) -> None:
    """A robot that stands still, or is told one thing alone, has no kinematics."""
    if not informative_coordinates(train.positions).any():
        raise DataError(
            f"the positions never move: all range over at most {CONSTANT_RANGE_MM:g} {unit}",
            where=where,
            fix="check `positions` and `position_unit` of the entry, or record poses that differ",
        )
    n_distinct = len(np.unique(train.commands, axis=0))
    if n_distinct < MIN_DISTINCT_COMMANDS:
        raise DataError(
            f"{n_distinct} distinct command{'s' * (n_distinct != 1)}, of at least {MIN_DISTINCT_COMMANDS}",
            where=where,
            fix="check `commands` of the entry, or record more distinct commands",
        )


def _in_unit_of_tables(rows: Samples, max_rows: int | None, unit: str) -> Samples:
    kept = rows.take(slice(max_rows))
    return replace(kept, positions=kept.positions * per_unit(unit))


def _warn_of_implausible_range(train: Samples, source: Mapping[str, Any], where: str) -> None:
    if unit_in_tables(source["position_unit"]) != MM:
        return
    widest = np.ptp(train.positions, axis=0).max()
    if not PLAUSIBLE_MM[0] <= widest <= PLAUSIBLE_MM[1]:
        fix = f"unless the robot is of that size, correct `position_unit`, which is {source['position_unit']}"
        logger.warning("%s", DataError(f"positions range over {widest:.3g} mm", where=where, fix=fix))


def _constant_coordinates(train: Samples) -> list[str]:
    moving = informative_coordinates(train.positions)
    names = coordinate_columns(len(moving) // 3)
    return [name for name, moves in zip(names, moving, strict=True) if not moves]
