"""The orientation of a robot's tip, which a file may hold beside positions: its columns, and its mean on `train`."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from softkin.core.errors import DataError
from softkin.core.rotations import DEGREES, RADIANS, TOLERANCE, XYZW, about, are_none, mean_of, to_numbers, to_vectors
from softkin.core.samples import TRAIN, Array, Samples
from softkin.data.readers import columns

logger = logging.getLogger("softkin")

#: The key of an entry, and of a dataset's description, for the orientation.
KEY = "orientation"
#: Degrees from the mean: near a half turn a rotation vector jumps to its negative.
FAR_TURN = 150.0


def places(names: Sequence[str], source: Mapping[str, Any], used: Sequence[int]) -> list[int]:
    """Places of the columns that the entry names as the orientation, none where it names none; `used` are those of all
    else that it names.

    Raises:
        DataError: no such column, or one that is used.
    """
    if KEY not in source:
        return []
    found = columns.choose(names, source[KEY]["columns"], f"{KEY}.columns")
    if twice := [names[place] for place in found if place in used]:
        raise DataError(
            f"'{twice[0]}' stands in `commands`, `positions`, `split`, `order` or `session`, too",
            where=f"`{KEY}.columns`",
            fix="name each column once; write lists of names in place of patterns",
        )
    return found


def without_zeros(numbers: Array, source: Mapping[str, Any]) -> Array:
    """The columns (n_rows, n_columns) with NaN for what a tracker that lost its body writes, nothing but zeros, where
    `missing` of the entry leaves gaps out and zeros are no orientation: a quaternion, a matrix.
    """
    if KEY not in source or "missing" not in source or source[KEY]["kind"] in (DEGREES, RADIANS):
        return numbers
    return np.where((numbers == 0).all(axis=1, keepdims=True), np.nan, numbers)


def vectors_of(numbers: Array, source: Mapping[str, Any], place: Callable[[int], str]) -> Array | None:
    """Rotation vectors (n_rows, 3) in rad of the columns (n_rows, n_columns); None where the entry names none.

    Raises:
        DataError: a row is no rotation.
    """
    if KEY not in source:
        return None
    kind, named = source[KEY]["kind"], source[KEY]["columns"]
    if (bad := np.flatnonzero(are_none(numbers, kind))).size:
        row, count = int(bad[0]), f" (in {len(bad)} of {len(numbers)} rows)" if len(bad) > 1 else ""
        norm = np.linalg.norm(numbers[row])
        what = f"no quaternion: its norm is {norm:.4g}, not 1 within {TOLERANCE:g}"
        raise DataError(
            (what if len(named) == 4 else "no rotation: nine numbers, row by row, that are not orthonormal") + count,
            where=f"{place(row)}, columns {', '.join(named)}",
            fix=f"delete the rows, or correct `columns` and `kind` of `{KEY}` in the entry",
        )
    return to_vectors(numbers, kind)


def about_mean(samples: Mapping[str, Samples], source: Mapping[str, Any]) -> tuple[dict[str, Samples], dict[str, Any]]:
    """The samples with their orientation about the mean of `train`, and what a description says of it; the same samples
    and nothing where the entry names none.
    """
    if KEY not in source:
        return dict(samples), {}
    vectors = {subset: np.asarray(rows.orientation) for subset, rows in samples.items()}
    mean = mean_of(vectors[TRAIN])
    turned = {subset: replace(rows, orientation=about(vectors[subset], mean)) for subset, rows in samples.items()}
    _warn_of_half_turns(turned[TRAIN], source)
    said = {**source[KEY], "mean_xyzw": to_numbers(mean[None], XYZW)[0].tolist(), "mean_vector": mean.tolist()}
    return turned, {KEY: said}


def _warn_of_half_turns(train: Samples, source: Mapping[str, Any]) -> None:
    """Say that the tip turns so far that what is modelled jumps."""
    turns = np.degrees(np.linalg.norm(np.asarray(train.orientation), axis=1))
    if (n_far := int((turns > FAR_TURN).sum())) > 0:
        what = f"{n_far} of {len(turns)} rows of `train` are turned by more than {FAR_TURN:g} degrees from their mean"
        fix = "check `kind` and the order of its columns; a tip that turns so far is modelled badly, as its scores show"
        logger.warning("%s", DataError(what, where=f"`{KEY}`, columns {', '.join(source[KEY]['columns'])}", fix=fix))
