from __future__ import annotations

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.named_arrays import table_of_arrays


def test_axes_beyond_the_first_are_columns() -> None:
    arrays = {"u": np.ones((4, 1, 2)), "position": np.ones((4, 2, 3)), "t": np.arange(4), "rate": np.array(50.0)}
    table = table_of_arrays(arrays)
    markers = [f"position{marker}_{axis}" for marker in (1, 2) for axis in "xyz"]
    assert table.names == ("u_1", "u_2", *markers, "t")
    assert table.read([len(table.names) - 1], [])[0].ravel().tolist() == [0, 1, 2, 3]


def test_arrays_without_rows_are_listed_with_their_shapes() -> None:
    with pytest.raises(DataError, match=r"rate \(\)"):
        table_of_arrays({"rate": np.array(50.0)})
