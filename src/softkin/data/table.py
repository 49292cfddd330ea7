"""The tidy table of a dataset: one Parquet file with columns subset, u1, ..., m1_x, ... (mm).

A stage names the one subset that it may see; no other row is read from the disk.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.errors import DataError
from softkin.core.files import replacing
from softkin.core.samples import SUBSETS, Samples, command_columns, coordinate_columns

if TYPE_CHECKING:
    import pandera.pandas as pandera


def schema(n_commands: int, n_markers: int) -> pandera.DataFrameSchema:
    """The schema of a tidy table: these columns in this order, finite 64-bit floats, the names of the four subsets."""
    import pandera.pandas as pa

    number = pa.Column(float, pa.Check(np.isfinite, error="must be finite"), nullable=False)
    columns = {"subset": pa.Column(str, pa.Check.isin(SUBSETS), nullable=False)}
    columns |= dict.fromkeys([*command_columns(n_commands), *coordinate_columns(n_markers)], number)
    return pa.DataFrameSchema(columns, strict=True, ordered=True)


def to_table(samples: Mapping[str, Samples]) -> pd.DataFrame:
    """Samples per subset (mm) as one table; the order of subsets and rows stays."""
    frames = []
    for subset, rows in samples.items():
        names = command_columns(rows.commands.shape[1]) + coordinate_columns(rows.positions.shape[1] // 3)
        frame = pd.DataFrame(np.hstack([rows.commands, rows.positions]), columns=names)
        frame.insert(0, "subset", subset)
        frames.append(frame)
    return pd.concat(frames, ignore_index=True)


def write_table(table: pd.DataFrame, path: str | Path) -> None:
    """Write the table in one step."""
    with replacing(path) as temporary:
        table.to_parquet(temporary, index=False)


def read_subset(path: str | Path, subset: str) -> Samples:
    """The samples of one subset of the tidy table at `path`.

    Raises:
        DataError: the table has no such rows.
    """
    frame = pd.read_parquet(path, filters=[("subset", "==", subset)])
    if frame.empty:
        raise DataError(
            f"no rows of subset '{subset}'", where=path, fix="delete the file and run again; rule prepare makes it anew"
        )
    is_command = frame.columns.str.match(r"u\d+$")
    is_coordinate = frame.columns.str.match(r"m\d+_[xyz]$")
    return Samples(
        np.ascontiguousarray(frame.loc[:, is_command].to_numpy(np.float64)),
        np.ascontiguousarray(frame.loc[:, is_coordinate].to_numpy(np.float64)),
    )


def content_hash(samples: Samples) -> str:
    """SHA-256 (hex) over the numbers of one subset and their shapes."""
    digest = hashlib.sha256()
    for array in (samples.commands, samples.positions):
        digest.update(f"{array.shape}".encode())
        digest.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()
