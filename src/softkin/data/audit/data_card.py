"""Audit a dataset: its tidy table -> its data card, as JSON and as a readable page."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.files import write_json, write_text
from softkin.core.geometry.base_frame import base_frame
from softkin.core.samples import CONSTANT_RANGE_MM, SUBSETS, TRAIN, Array, Samples, command_columns, coordinate_columns
from softkin.data.audit import CHECKS
from softkin.data.audit.findings import LEAK, worst_severity
from softkin.data.audit.page import page
from softkin.data.readers.complete_rows import GAPS
from softkin.data.table import read_subset

logger = logging.getLogger("softkin")

#: Keys of a dataset's description, and of its card, for what was left out.
LEFT_OUT = ("removed_from_train", GAPS)


def audit(
    table: str | Path,
    *,
    dataset: str,
    title: str,
    position_unit: str,
    data_card: str | Path,
    readable: str | Path,
    without: Mapping[str, Any] | None = None,
    base: Mapping[str, Any] | None = None,
) -> None:
    """Run every check on a tidy table, and write the data card and its readable page.

    Parameters:
        table: path of the tidy table (Parquet, mm).
        dataset: name of the dataset.
        title: what tables and figures call it.
        position_unit: unit of positions in the dataset's own file, for the card.
        data_card: path of the card to write (JSON).
        readable: path of the page to write (Markdown).
        without: keys of the card for what was left out, of `left_out`; None where nothing was asked for.
        base: what the dataset's entry declares of the robot's base.

    Raises:
        DataError: a subset has no rows.
    """
    samples = {subset: read_subset(table, subset) for subset in SUBSETS}
    results = {name: check(samples) for name, check in CHECKS.items()}
    findings = [finding for result in results.values() for finding in result.findings]
    card: dict[str, Any] = {
        "dataset": dataset,
        "title": title,
        "worst_severity": worst_severity(findings),
        "is_leaking": any(finding.severity == LEAK for finding in findings),
        "findings": [finding.as_dict() for finding in findings],
        "unit": "mm",
        "unit_in_file": position_unit,
        "subsets": {subset: _description(rows) for subset, rows in samples.items()},
        **(without or {"removed_from_train": None}),
        "base": _base(samples[TRAIN], base or {}),
        "checks": {name: dict(result.numbers) for name, result in results.items()},
    }
    write_json(data_card, card)
    write_text(readable, page(card))
    for finding in findings:
        logger.info("%s: %s", finding.severity, finding.sentence)
    if not findings:
        logger.info("no findings in %d rows", sum(map(len, samples.values())))


def left_out(description: Mapping[str, Any]) -> dict[str, Any]:
    """The keys of a card for what a dataset's description says was left out: rows that cleaning dropped from `train`,
    by kind (None where it was not asked for), and what of the file was not read, where the entry asked for that.
    """
    return {key: description[key] for key in LEFT_OUT if key in description}


def _description(rows: Samples) -> dict[str, Any]:
    """Rows and ranges of one subset."""
    return {
        "rows": len(rows),
        "commands": _ranges(command_columns(rows.commands.shape[1]), rows.commands),
        "positions_mm": _ranges(coordinate_columns(rows.positions.shape[1] // 3), rows.positions),
    }


def _base(train: Samples, declared: Mapping[str, Any]) -> dict[str, Any]:
    """The base of the robot, where curvature coordinates start: as declared, and estimated from `train` otherwise."""
    points = train.positions.reshape(len(train), -1, 3)
    still = np.ptp(points, axis=0).max(axis=1) <= CONSTANT_RANGE_MM
    if still.all():
        return {"not_measured": "no marker moves"}
    frame = base_frame(train.commands, points, declared)
    known = [value is not None for value in declared.get("origin") or [None] * 3]
    rest = "a marker that never moves" if still.any() and not any(known) else "estimated"
    return {
        "origin_mm": frame.origin.tolist(),
        "origin_from": ["declared" if is_known else rest for is_known in known],
        "axis": frame.axis.tolist(),
        "axis_from": "declared" if declared.get("axis") else "estimated",
    }


def _ranges(names: list[str], values: Array) -> dict[str, list[float]]:
    return {name: [float(column.min()), float(column.max())] for name, column in zip(names, values.T, strict=True)}
