from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.cli.guess_entry import guess_entry
from softkin.data.readers import table_file
from softkin.data.readers.table_formats import open_table

WHEN = 1717150000.5 + np.arange(100) / 25


@pytest.mark.parametrize(
    ("seconds", "nanoseconds", "called"),
    [
        ("header.stamp.secs", "header.stamp.nsecs", "header.stamp"),
        ("header.stamp.sec", "header.stamp.nanosec", "header.stamp"),
        ("secs", "nsecs", "stamp"),
    ],
)
def test_seconds_and_nanoseconds_are_one_time(tmp_path: Path, seconds: str, nanoseconds: str, called: str) -> None:
    rows = "\n".join(f"{when // 1:.0f},{when % 1 * 1e9:.0f},{n % 7},{n},{n + 1},{n * n}" for n, when in enumerate(WHEN))
    (tmp_path / "bag.csv").write_text(f"{seconds},{nanoseconds},u1,x,y,z\n{rows}\n")
    table = open_table(tmp_path / "bag.csv", {})
    assert table.names[0] == called
    values, (stamp, text) = table.read([3, 0], [0, 1])
    np.testing.assert_allclose(values[:, 1], WHEN, atol=1e-6)
    np.testing.assert_array_equal(stamp, values[:, 1])
    assert text[0] == "1717150000"
    assert values[8, 0] == 1
    np.testing.assert_array_equal(table.look()[0], stamp)
    entry, _ = guess_entry(tmp_path / "bag.csv", "Bag", "bag.csv")
    assert (entry["order"], entry["split"]) == (called, {"method": "time", "column": called})
    rows_read = table_file.read(tmp_path / "bag.csv", dataset="bag", source=entry)
    assert sum(map(len, rows_read.values())) == 100


def test_a_date_and_a_time_of_the_day_are_one_time(tmp_path: Path) -> None:
    rows = "\n".join(f"2024-05-31,12:00:{n * 0.5:04.1f},{n % 7},{n},{n + 1},{n * n}" for n in range(100))
    (tmp_path / "log.csv").write_text(f"Date,Time,u1,x,y,z\n{rows}\n")
    table = open_table(tmp_path / "log.csv", {})
    assert table.names[0] == "date time"
    assert table.read([], [0])[1][0][:2].tolist() == ["2024-05-31T12:00:00.0", "2024-05-31T12:00:00.5"]
    (tmp_path / "log.csv").write_text("Date,Time,u1,x\n2024-05-31,0.5,1,2\n2024-05-31,1.5,1,2\n")
    assert open_table(tmp_path / "log.csv", {}).names[0] == "Date"
