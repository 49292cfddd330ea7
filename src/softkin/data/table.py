"""The tidy table of a dataset: one Parquet file with columns subset, u1, ..., m1_x, ... (mm).

A table that says when its rows were recorded has more columns before the positions: order, session, and what the robot
may remember of the commands before (`softkin.core.recording`); one that was split by blocks, the number of each; one
that knows the tip's orientation, after the positions, its rotation vector about the mean of `train` (rad).

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
from softkin.core.recording import CommandMemory, Recording, memory_columns
from softkin.core.samples import ROTATION_COLUMNS, SUBSETS, Samples, command_columns, coordinate_columns

if TYPE_CHECKING:
    import pandera.pandas as pandera


def schema(
    n_commands: int,
    n_markers: int,
    is_recorded: bool = False,
    has_blocks: bool = False,
    has_orientation: bool = False,
) -> pandera.DataFrameSchema:
    """The schema of a tidy table: these columns in this order, finite 64-bit floats, the names of the four subsets;
    where it is recorded an order without repetition, and sessions from 1; where it has blocks their numbers from 0.
    """
    import pandera.pandas as pa

    number = pa.Column(float, pa.Check(np.isfinite, error="must be finite"), nullable=False)
    columns = {"subset": pa.Column(str, pa.Check.isin(SUBSETS), nullable=False)}
    columns |= dict.fromkeys(command_columns(n_commands), number)
    if is_recorded:
        columns |= {"order": pa.Column(int, unique=True), "session": pa.Column(int, pa.Check.ge(1))}
        columns |= dict.fromkeys(memory_columns(n_commands), number)
    if has_blocks:
        columns |= {"block": pa.Column(int, pa.Check.ge(0))}
    columns |= dict.fromkeys(coordinate_columns(n_markers), number)
    if has_orientation:
        columns |= dict.fromkeys(ROTATION_COLUMNS, number)
    return pa.DataFrameSchema(columns, strict=True, ordered=True)


def to_table(samples: Mapping[str, Samples]) -> pd.DataFrame:
    """Samples per subset (mm) as one table; the order of subsets and rows stays."""
    frames = []
    for subset, rows in samples.items():
        n_commands, recording = rows.commands.shape[1], rows.recording
        parts = [pd.DataFrame(rows.commands, columns=command_columns(n_commands))]
        if recording is not None:
            parts.append(pd.DataFrame({"order": recording.order, "session": recording.session}))
            parts.append(pd.DataFrame(recording.memory, columns=memory_columns(n_commands)))
        if rows.block is not None:
            parts.append(pd.DataFrame({"block": rows.block}))
        parts.append(pd.DataFrame(rows.positions, columns=coordinate_columns(rows.positions.shape[1] // 3)))
        if rows.orientation is not None:
            parts.append(pd.DataFrame(rows.orientation, columns=ROTATION_COLUMNS))
        frame = pd.concat(parts, axis=1)
        frame.insert(0, "subset", subset)
        frames.append(frame)
    table = pd.concat(frames, ignore_index=True)
    if recording is not None:
        table.attrs = {"rest": recording.robot.rest.tolist(), "ranges": recording.robot.ranges.tolist()}
    return table


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
    commands = np.ascontiguousarray(frame.loc[:, is_command].to_numpy(np.float64))
    recording = None
    if "order" in frame:
        memory = np.ascontiguousarray(frame[memory_columns(commands.shape[1])].to_numpy(np.float64))
        robot = CommandMemory(np.array(frame.attrs["rest"]), np.array(frame.attrs["ranges"]))
        order, session = (frame[name].to_numpy(np.int64) for name in ("order", "session"))
        recording = Recording(order, session, memory, robot)
    positions = np.ascontiguousarray(frame.loc[:, is_coordinate].to_numpy(np.float64))
    block = frame["block"].to_numpy(np.int64) if "block" in frame else None
    turned = (
        np.ascontiguousarray(frame[ROTATION_COLUMNS].to_numpy(np.float64)) if ROTATION_COLUMNS[0] in frame else None
    )
    return Samples(commands, positions, recording, block, turned)


def content_hash(samples: Samples) -> str:
    """SHA-256 (hex) over the numbers of one subset and their shapes; of its recording, too, where it has one, and of
    its orientation.
    """
    digest = hashlib.sha256()
    recording = samples.recording
    when = () if recording is None else (recording.order, recording.session, recording.memory)
    block = () if samples.block is None else (samples.block,)
    turned = () if samples.orientation is None else (samples.orientation,)
    for array in (samples.commands, samples.positions, *when, *block, *turned):
        digest.update(f"{array.shape}".encode())
        digest.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()
