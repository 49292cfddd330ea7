from __future__ import annotations

import re
from dataclasses import replace

from tests.unit.uncertainty.small_robot import small_robot


def test_a_model_says_what_it_is_in_eight_lines() -> None:
    robot = replace(small_robot(shells=True), about={"data": "ab" * 32, "date": "2026-01-02"})
    lines = repr(robot).splitlines()
    assert [line.split()[0] for line in lines] == [
        *("robot", "model", "intervals", "inside", "outside", "promise", "data", "date")
    ]
    assert lines[0].endswith("arm, 2 commands to 1 marker")
    error = float(re.findall(r"[\d.]+", lines[3])[0])
    assert 0.1 < error < 0.3  # noise of 0.1 mm in each of three coordinates
    assert "beyond the largest core" in lines[4]
    assert "abababab" in lines[6]
    assert lines[7].endswith("2026-01-02")


def test_what_is_not_known_has_no_line() -> None:
    lines = repr(small_robot(named=False)).splitlines()
    assert len(lines) == 6
    assert "nothing is known of errors in extrapolation" in lines[4]
    assert "no guarantee" not in lines[5]
