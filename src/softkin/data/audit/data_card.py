"""Audit a dataset: its tidy table -> its data card, as JSON and as a readable page."""

from __future__ import annotations

import logging
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.files import write_json, write_text
from softkin.core.geometry.base_frame import base_frame, markers_at_the_base
from softkin.core.samples import (
    CONSTANT_RANGE_MM,
    SUBSETS,
    TRAIN,
    Array,
    Samples,
    command_columns,
    coordinate_columns,
    informative_coordinates,
)
from softkin.core.units import in_unit, unit_of
from softkin.data.audit import CHECKS
from softkin.data.audit.findings import LEAK, Finding, worst_severity
from softkin.data.audit.page import page
from softkin.data.marker_order import RELABELLED
from softkin.data.orientation import KEY
from softkin.data.readers.columns import ORIENTATION, UNUSED
from softkin.data.readers.complete_rows import COUNTED
from softkin.data.scored_rows import DRAWN_FROM
from softkin.data.table import read_subset

logger = logging.getLogger("softkin")

#: Keys of a dataset's description, and of its card, for what was left out or mended, and for the orientation.
LEFT_OUT = ("removed_from_train", *COUNTED, RELABELLED, UNUSED, ORIENTATION, KEY, DRAWN_FROM)
#: Names of columns in softkin's tables, in a sentence.
COLUMN = re.compile(r"\b(?:u\d+|m\d+_[xyz])\b")


def audit(
    table: str | Path,
    *,
    dataset: str,
    title: str,
    position_unit: str,
    data_card: str | Path,
    readable: str | Path,
    description: Mapping[str, Any] | None = None,
    base: Mapping[str, Any] | None = None,
) -> None:
    """Run every check on a tidy table, and write the data card and its readable page.

    Parameters:
        table: path of the tidy table (Parquet).
        dataset: name of the dataset.
        title: what tables and figures call it.
        position_unit: unit of positions in the dataset's own file, for the card.
        data_card: path of the card to write (JSON).
        readable: path of the page to write (Markdown).
        description: of the dataset: what was left out or mended, what its file calls its columns, and a unit that is
            not mm; None where nothing is known of it.
        base: what the dataset's entry declares of the robot's base.

    Raises:
        DataError: a subset has no rows.
    """
    samples = {subset: read_subset(table, subset) for subset in SUBSETS}
    results = {name: check(samples) for name, check in CHECKS.items()}
    about = description or {}
    unit = unit_of(about)
    own = _own_names(samples[TRAIN], about.get("columns"))
    findings = [_in_own_words(finding, own, unit) for result in results.values() for finding in result.findings]
    card: dict[str, Any] = {
        "dataset": dataset,
        "title": title,
        "worst_severity": worst_severity(findings),
        "is_leaking": any(finding.severity == LEAK for finding in findings),
        "findings": [finding.as_dict() for finding in findings],
        "unit": unit,
        "unit_in_file": position_unit,
        "subsets": {subset: _description(rows) for subset, rows in samples.items()},
        **({"removed_from_train": None} | left_out(about)),
        "base": _base(samples[TRAIN], base or {}, unit),
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
    by kind (None where it was not asked for), what of the file was not read, columns that are not used, and rows whose
    markers were put in order, where the entry asked for that; and which columns are the orientation.
    """
    return {key: description[key] for key in LEFT_OUT if key in description}


def _own_names(train: Samples, columns: Mapping[str, Any] | None) -> dict[str, str]:
    """Name of a column in tables -> what the robot's own file calls it; empty where that is not known."""
    if columns is None:
        return {}
    coordinates = coordinate_columns(train.positions.shape[1] // 3)
    named = [name for name in coordinates if columns["dimensions"] == 3 or not name.endswith("z")]
    commands = zip(command_columns(train.commands.shape[1]), columns["commands"], strict=True)
    return dict([*commands, *zip(named, columns["positions"], strict=True)])


def _in_own_words(finding: Finding, own: Mapping[str, str], unit: str) -> Finding:
    """The finding with columns called as in the robot's own file, and lengths, which checks say in mm, in its unit."""
    sentence = COLUMN.sub(lambda match: own.get(match.group(), match.group()), in_unit(finding.sentence, unit))
    return replace(finding, sentence=sentence)


def _description(rows: Samples) -> dict[str, Any]:
    """Rows and ranges of one subset."""
    return {
        "rows": len(rows),
        "commands": _ranges(command_columns(rows.commands.shape[1]), rows.commands),
        "positions_mm": _ranges(coordinate_columns(rows.positions.shape[1] // 3), rows.positions),
    }


def _base(train: Samples, declared: Mapping[str, Any], unit: str) -> dict[str, Any]:
    """The base of the robot, where curvature coordinates start: as declared, and estimated from `train` otherwise."""
    points = train.positions.reshape(len(train), -1, 3)
    if not informative_coordinates(train.positions).any():
        return {"not_measured": "no marker moves"}
    frame = base_frame(train.commands, points, declared)
    known = [value is not None for value in declared.get("origin") or [None] * 3]
    rest = "estimated"
    if markers_at_the_base(points).any() and not any(known):
        constant = np.ptp(points, axis=0).max(axis=1) <= CONSTANT_RANGE_MM
        rest = "a marker that never moves" if constant.any() else "a marker that hardly moves"
    refused = {} if frame.refused_mm is None else {"refused_mm": frame.refused_mm}
    if refused:
        logger.warning(
            "the base was estimated %.3g %s from the markers, out of reach, and is not used", frame.refused_mm, unit
        )
    return refused | {
        "origin_mm": frame.origin.tolist(),
        "origin_from": ["declared" if is_known else rest for is_known in known],
        "axis": frame.axis.tolist(),
        "axis_from": "declared" if declared.get("axis") else "estimated",
    }


def _ranges(names: list[str], values: Array) -> dict[str, list[float]]:
    return {name: [float(column.min()), float(column.max())] for name, column in zip(names, values.T, strict=True)}
