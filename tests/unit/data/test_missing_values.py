from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.missing_values import check_whole, lacks_value


@pytest.mark.parametrize(
    ("column", "lacking"),
    [
        (np.array(["a", "", " \t", None, float("nan"), 0, "nan"], dtype=object), [0, 1, 1, 1, 1, 0, 0]),
        (np.array([0.0, np.nan, np.inf]), [0, 1, 0]),
        (np.array([0, 1]), [0, 0]),
        (np.array([], dtype=object), []),
    ],
)
def test_none_nan_and_blanks_are_no_values(column: Any, lacking: list[int]) -> None:
    assert lacks_value(column).tolist() == [bool(cell) for cell in lacking]


def test_a_cell_without_value_is_named() -> None:
    check_whole("trial", np.array([1, 2]), "group", str)
    with pytest.raises(DataError, match=r"line 1, column 'trial': no value, so the group of the row is unknown"):
        check_whole("trial", np.array([1.0, np.nan, np.nan]), "group", lambda row: f"line {row}")
