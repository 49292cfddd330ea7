"""Reader of the published JSON files: {"train"|"val"|"test"|"ext": {"motor_control": [n][p], "position": [n][m][3]}}.

Source: Yoon et al. (2024), doi 10.21227/5h7v-aq35.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.errors import DataError
from softkin.core.samples import EXTRAPOLATION, MAX_MAGNITUDE, TEST, TRAIN, VALIDATION, Array, Samples
from softkin.core.strict_json import NotStrictJson, parse_json

SUBSET_KEYS = {TRAIN: "train", VALIDATION: "val", TEST: "test", EXTRAPOLATION: "ext"}


def read(path: str | Path, *, dataset: str, source: Mapping[str, Any]) -> dict[str, Samples]:
    """Samples per subset, positions in the file's own unit.

    Raises:
        DataError: anything that is not `n_commands` and `n_markers` x 3 finite numbers per row, as the entry
            `source` says; names the dataset, subset, field and row.
    """

    def fail(what: str, where: str = "whole file") -> DataError:
        return DataError(
            what,
            where=f"dataset '{dataset}', file {path}, {where}",
            fix="delete the file to retrieve it again, or correct it or its entry in config/datasets.yaml",
        )

    try:
        content = parse_json(Path(path).read_text(encoding="utf-8"), any_number=True)
    except NotStrictJson as error:
        raise fail(str(error)) from error
    except (OSError, UnicodeDecodeError) as error:
        raise fail(f"not JSON: {error}") from error
    if not isinstance(content, dict):
        raise fail(f"expected an object with the keys {', '.join(SUBSET_KEYS.values())}")

    subsets = {}
    for subset, key in SUBSET_KEYS.items():
        if not isinstance(content.get(key), dict):
            raise fail("missing, or not an object", f"subset '{key}'")
        arrays = {}
        for field, shape in (("motor_control", (source["n_commands"],)), ("position", (source["n_markers"], 3))):
            where = f"subset '{key}', field '{field}'"
            rows = content[key].get(field)
            if not isinstance(rows, list):
                raise fail("missing, or not a list", where)
            if not rows:
                raise fail("empty subset: no rows", where)
            for index, row in enumerate(rows):
                problem = _problem(row, shape)
                if problem:
                    raise fail(problem, f"{where}, row {index}")
            arrays[field] = _matrix(rows)
        lengths = {field: len(rows) for field, rows in arrays.items()}
        if len(set(lengths.values())) > 1:
            raise fail(f"fields of different length: {lengths}", f"subset '{key}'")
        subsets[subset] = Samples(arrays["motor_control"], arrays["position"])
    return subsets


def _matrix(rows: list[Any]) -> Array:
    return np.asarray(rows, dtype=np.float64).reshape(len(rows), -1)


def _problem(value: Any, shape: tuple[int, ...]) -> str | None:
    """Why `value` is not an array of finite numbers of `shape`, or None."""
    if not shape:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            return f"expected a number, not {json.dumps(value)[:40]}"
        if not math.isfinite(value):
            return f"not finite: {value}"
        return None if abs(value) <= MAX_MAGNITUDE else f"too large a number: {value:g}"
    if not isinstance(value, list) or len(value) != shape[0]:
        size = f"{len(value)} values" if isinstance(value, list) else json.dumps(value)[:40]
        return f"wrong shape: expected {shape[0]} values, not {size}"
    return next((problem for item in value if (problem := _problem(item, shape[1:]))), None)
