"""Rows of a dataset: groups of equal rows, seeded samples of rows, subsets stacked and split, the scale of commands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.samples import Array, Samples

Indices = NDArray[np.int64]

#: Rows worked on at a time, so that a million rows stand in memory once.
CHUNK = 50_000
#: More rows than published robots have in a subset: what is fitted on more predicts in parts of at most `PART` rows,
#: whose kernels stay in the cache. The last bits of its predictions follow from that; on fewer they stay as they were.
MANY_ROWS, PART = 3_500, 1_000


def chunks(n_rows: int) -> Iterator[slice]:
    """Slices of at most `CHUNK` rows, in order."""
    return (slice(start, start + CHUNK) for start in range(0, n_rows, CHUNK))


def in_parts(values: Array, at_most: int) -> list[Array]:
    """The rows of `values` (n_rows, n_columns) in their order, in parts of at most so many; at least one."""
    return np.array_split(values, max(1, -(-len(values) // at_most)))


def stacked_commands(samples: Mapping[str, Samples]) -> Array:
    """The commands of all subsets (n_rows, n_commands), one below the other."""
    return np.concatenate([rows.commands for rows in samples.values()])


def stacked_positions(samples: Mapping[str, Samples], coordinates: NDArray[np.bool_]) -> Array:
    """The positions of all subsets (n_rows, n_coordinates where the mask is True) in mm, one below the other."""
    result = np.empty((sum(map(len, samples.values())), int(coordinates.sum())))
    start = 0
    for rows in samples.values():
        result[start : start + len(rows)] = rows.positions[:, coordinates]
        start += len(rows)
    return result


def row_groups(values: Array) -> Indices:
    """Number (n_rows,) of the distinct row that each row of `values` (n_rows, n_columns) equals, from 0 in order of
    appearance. Rows are equal when all bits are, but 0.0 equals -0.0.

    Rows are compared by a hash of 64 bits: among a million distinct rows, two share one with a probability of 3e-8.
    """
    hashes = np.empty(len(values), dtype=np.uint64)
    for part in chunks(len(values)):
        hashes[part] = pd.util.hash_pandas_object(pd.DataFrame(values[part] + 0.0), index=False).to_numpy()
    return np.asarray(pd.factorize(hashes)[0], dtype=np.int64)


def first_of_each(groups: Indices) -> Indices:
    """Row number of the first row of each group, in order of appearance."""
    return np.sort(np.unique(groups, return_index=True)[1])


def repeats_an_earlier_row(groups: Indices) -> NDArray[np.bool_]:
    """Mask (n_rows,) of the rows whose group has an earlier row."""
    repeated = np.ones(len(groups), dtype=bool)
    repeated[first_of_each(groups)] = False
    return repeated


def shares_its_pose(poses: Indices, commands: Indices) -> NDArray[np.bool_]:
    """Mask (n_rows,) of the rows whose pose stands at another command too; both arguments are `row_groups`."""
    pairs = np.unique(np.column_stack([poses, commands]), axis=0)
    return np.asarray((np.bincount(pairs[:, 0]) > 1)[poses])


def sampled_rows(n_rows: int, at_most: int, seed: int) -> Indices:
    """Ascending row numbers: all, or `at_most` drawn without replacement."""
    if n_rows <= at_most:
        return np.arange(n_rows)
    return np.sort(np.random.default_rng(seed).choice(n_rows, at_most, replace=False))


def command_scale(train_commands: Array) -> Array:
    """Standard deviation (n_commands,) of each command on `train`; 1 where it never varies."""
    spread = train_commands.std(axis=0)
    return np.where(np.ptp(train_commands, axis=0) > 0, spread, 1.0)


def split_by_subset(values: NDArray[np.generic], samples: Mapping[str, Samples]) -> dict[str, NDArray[np.generic]]:
    """Subset -> its `values`, out of those of all subsets stacked in the order of `samples`."""
    ends = np.cumsum([len(rows) for rows in samples.values()])[:-1]
    return dict(zip(samples, np.split(values, ends), strict=True))
