from __future__ import annotations

from pathlib import Path

import ezc3d
import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import open_table


def test_labels_rate_unit_and_gaps_are_read(tmp_path: Path) -> None:
    take = ezc3d.c3d()
    take["parameters"]["POINT"]["RATE"]["value"] = [50]
    take["parameters"]["POINT"]["LABELS"]["value"] = ("base", "tip")
    take["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    points = np.ones((4, 2, 3))
    points[:3] = np.arange(18.0).reshape(3, 2, 3)
    points[:3, 1, 2] = np.nan
    take["data"]["points"] = points
    take.write(str(tmp_path / "take.c3d"))
    table = open_table(tmp_path / "take.c3d", {})
    assert table.names == ("Frame", "time", *(f"{label}_{axis}" for label in ("base", "tip") for axis in "xyz"))
    assert table.units[1:3] == ("s", "mm")
    values, _ = table.read(range(8), [], gaps=True)
    assert values[:, 1].tolist() == [0.0, 0.02, 0.04]
    assert values[1, 2:].tolist() == [1, 7, 13, 4, 10, 16]
    assert np.isnan(values[2, 5:]).all()
    assert not np.isnan(values[2, :5]).any()


def test_a_damaged_file_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "take.c3d").write_bytes(b"\x02\x50" + b"\0" * 510)
    with pytest.raises(DataError, match="C3D"):
        open_table(tmp_path / "take.c3d", {})
