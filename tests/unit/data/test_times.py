from __future__ import annotations

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.times import times


@pytest.mark.parametrize(
    ("cells", "seconds"),
    [
        (["0,5", "1", "1.5"], [0.5, 1.0, 1.5]),
        (["12:00:01", "12:00:01.5", "12:01:01,25"], [43201.0, 43201.5, 43261.25]),
        (["9:59:59:90", "10:00:00:10", "10:00:00:20"], [35999.9, 36000.1, 36000.2]),
    ],
)
def test_numbers_and_times_of_the_day_are_seconds(cells: list[str], seconds: list[float]) -> None:
    np.testing.assert_allclose(times("t", np.array(cells, dtype=object), str), seconds)


def test_dates_sort_as_they_follow_each_other() -> None:
    dates = np.array(["2024-05-31 12:00:00.5", "2024-05-31 12:00:00", "2024-06-01 00:00:00"], dtype=object)
    assert np.argsort(times("t", dates, str)).tolist() == [1, 0, 2]


def test_a_date_whose_day_and_month_are_open_is_refused() -> None:
    with pytest.raises(DataError, match="'05/06/2024 12:00:00' is no time"):
        times("t", np.array(["05/06/2024 12:00:00"], dtype=object), str)
