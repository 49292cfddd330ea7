from __future__ import annotations

from pathlib import Path

import numpy as np
import pandera.errors
import pytest

from softkin.core.errors import DataError
from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import content_hash, read_subset, schema, to_table, write_table
from tests.conftest import bending_arm, four_subsets


def test_each_subset_comes_back_as_it_went_in(tmp_path: Path) -> None:
    subsets = four_subsets({"train": 9, "validation": 3, "test": 4, "extrapolation": 5}, n_commands=3, n_markers=2)
    write_table(to_table(subsets), tmp_path / "table.parquet")
    for subset in SUBSETS:
        rows = read_subset(tmp_path / "table.parquet", subset)
        np.testing.assert_array_equal(rows.commands, subsets[subset].commands)
        np.testing.assert_array_equal(rows.positions, subsets[subset].positions)


def test_an_absent_subset_is_an_error(tmp_path: Path) -> None:
    write_table(to_table({"train": bending_arm(3)}), tmp_path / "table.parquet")
    with pytest.raises(DataError, match="no rows of subset 'test'"):
        read_subset(tmp_path / "table.parquet", "test")


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_the_schema_refuses_what_is_not_finite(value: float) -> None:
    frame = to_table({"train": bending_arm(3)})
    schema(2, 1).validate(frame)
    frame.loc[1, "m1_y"] = value
    with pytest.raises(pandera.errors.SchemaError, match="m1_y"):
        schema(2, 1).validate(frame)


def test_the_schema_refuses_other_columns_and_subsets() -> None:
    frame = to_table({"train": bending_arm(3)})
    for bad in (frame.drop(columns="u2"), frame.assign(extra=1.0), frame.assign(subset="holdout")):
        with pytest.raises((pandera.errors.SchemaError, pandera.errors.SchemaErrors)):
            schema(2, 1).validate(bad)


def test_the_hash_sees_every_number_and_the_shape() -> None:
    rows = bending_arm(5)
    moved = Samples(rows.commands, rows.positions + np.eye(5, 3) * 1e-12)
    flat = Samples(rows.commands.reshape(2, 5), rows.positions)
    assert content_hash(rows) == content_hash(bending_arm(5))
    assert len({content_hash(rows), content_hash(moved), content_hash(flat)}) == 3


def test_blocks_go_through_the_table_and_its_hash(tmp_path: Path) -> None:
    rows = Samples(np.arange(8.0).reshape(4, 2), np.arange(12.0).reshape(4, 3), block=np.array([0, 0, 2, 1]))
    subsets = dict.fromkeys(SUBSETS, rows)
    frame = to_table(subsets)
    schema(2, 1, has_blocks=True).validate(frame)
    write_table(frame, tmp_path / "table.parquet")
    read = read_subset(tmp_path / "table.parquet", "test")
    assert read.block is not None
    assert read.block.tolist() == [0, 0, 2, 1]
    assert content_hash(read) == content_hash(rows) != content_hash(Samples(rows.commands, rows.positions))
