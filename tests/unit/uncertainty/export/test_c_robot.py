from __future__ import annotations

from softkin.uncertainty.export.c_robot import bounds_text, inputs_text
from softkin.uncertainty.export.c_text import Tables
from softkin.uncertainty.export.numbers import exported_numbers
from tests.exported_robots import remembering, small


def test_memory_is_written_where_there_is_one() -> None:
    told = [
        inputs_text(exported_numbers(robot, most=10**6), Tables("arm"), 9) for robot in (small("lr"), remembering())
    ]
    assert ["play" in text for text in told] == [False, True]


def test_bounds_outside_are_written_where_there_are_shells() -> None:
    written = []
    for name in ("lr", "lasso", "rf"):
        numbers = exported_numbers(small(name), most=10**6)
        written.append("answer->outside" in bounds_text(numbers, Tables("arm"), len(numbers["coordinates"])))
    assert written == [bool(small(name).shells) for name in ("lr", "lasso", "rf")] == [True, True, False]
