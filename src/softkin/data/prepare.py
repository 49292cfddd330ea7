"""Prepare: a retrieved file -> the tidy table in mm, and a description of it."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pooch

from softkin.core.errors import SoftkinError
from softkin.core.files import write_json
from softkin.core.samples import SUBSETS, TRAIN, Samples, coordinate_columns, informative_coordinates
from softkin.data.readers import READERS
from softkin.data.table import content_hash, schema, to_table, write_table

logger = logging.getLogger("softkin")

#: Positions that range over less or more than this are probably not in the unit that the entry says.
PLAUSIBLE_MM = (1.0, 10_000.0)
MM_PER_UNIT = {"m": 1000.0, "cm": 10.0, "mm": 1.0, "in": 25.4}


def prepare(
    raw: str | Path,
    *,
    dataset: str,
    source: Mapping[str, Any],
    table: str | Path,
    description: str | Path,
    max_rows: int | None = None,
    clean: Callable[[Mapping[str, Samples]], tuple[dict[str, Samples], dict[str, int]]] | None = None,
) -> None:
    """Read `raw` as its entry `source` says, check it, write the `table` (Parquet, mm) and the `description` (JSON).

    `max_rows` keeps the first rows of each subset only (for trying the pipeline out); None keeps all. `clean`, if
    given, drops rows of `train` and counts them; the description says how many.

    Raises:
        SoftkinError: the file is not what its entry in config/datasets.yaml says.
    """
    samples = READERS[source["format"]](raw, dataset=dataset, source=source)
    n_commands, n_markers = samples[TRAIN].commands.shape[1], samples[TRAIN].positions.shape[1] // 3
    sizes = {subset: len(rows) for subset, rows in samples.items()}
    expected = source.get("rows", sizes)
    for subset in SUBSETS:
        if sizes[subset] != expected[subset]:
            raise SoftkinError(
                f"dataset '{dataset}', subset '{subset}': {sizes[subset]} rows, but config/datasets.yaml registers "
                f"{expected[subset]}\n  in {raw}\n  mend: correct `rows` of the entry, or the file"
            )
    factor = MM_PER_UNIT[source["position_unit"]]
    samples = {
        subset: Samples(rows.commands[:max_rows], rows.positions[:max_rows] * factor)
        for subset, rows in samples.items()
    }
    removed = None
    if clean is not None:
        samples, removed = clean(samples)
        logger.info("cleaned train: %s", ", ".join(f"{count} {what}" for what, count in removed.items()))
    widest = np.ptp(samples[TRAIN].positions, axis=0).max()
    if not PLAUSIBLE_MM[0] <= widest <= PLAUSIBLE_MM[1]:
        logger.warning(
            "dataset '%s', file %s: positions range over %.3g mm\n  mend: if that is no such robot, correct "
            "`position_unit`, which is %s",
            *(dataset, source["file"], widest, source["position_unit"]),
        )
    frame = to_table(samples)
    schema(n_commands, n_markers).validate(frame)
    write_table(frame, table)

    moving = informative_coordinates(samples[TRAIN].positions)
    names = coordinate_columns(n_markers)
    write_json(
        description,
        {
            "dataset": dataset,
            "title": source["title"],
            "origin": "stand-in" if "robot" in source else "published" if "urls" in source else "own",
            "sha256": source.get("sha256") or pooch.file_hash(str(raw), alg="sha256"),
            "n_commands": n_commands,
            "n_markers": n_markers,
            "rows": {subset: len(rows) for subset, rows in samples.items()},
            "removed_from_train": removed,
            "is_cut": max_rows is not None and any(size > max_rows for size in sizes.values()),
            "content_sha256": {subset: content_hash(rows) for subset, rows in samples.items()},
            "constant_coordinates": [name for name, moves in zip(names, moving, strict=True) if not moves],
        },
    )
    logger.info("%d rows, %d commands, %d coordinates", len(frame), n_commands, 3 * n_markers)
