from __future__ import annotations

import math
from typing import Any

import pytest

from softkin.core import plain_values
from softkin.core.plain_values import MAX_DEPTH, problems_of_values


def nested(depth: int) -> Any:
    return [nested(depth - 1)] if depth else 1


def test_plain_values_have_no_problem() -> None:
    assert problems_of_values({"a": [1, -2.5, "x\ty\n", None, True], "b": {"c": {}}, "d": 2**53}) == []
    assert problems_of_values({"a": nested(MAX_DEPTH - 1)}) == []


@pytest.mark.parametrize(
    ("config", "place"),
    [
        ({"a": math.nan}, "a: nan"),
        ({"a": {"b": [1, -math.inf]}}, "a.b.1: -inf"),
        ({"a": 2**53 + 1}, "a: a whole number"),
        ({"a": 10**5000}, "a: a whole number"),
        ({"a": 1e300}, "a: 1e+300"),
        ({"a": "x\0"}, "a: a control character"),
        ({"a": "x" * 10_001}, "a: 10001 characters"),
        ({"a": {1: 2}}, "a: the key 1"),
        ({True: 2}, "top level: the key True"),
        ({"a": nested(MAX_DEPTH)}, "a: nested deeper"),
    ],
)
def test_a_problem_is_told_at_its_place(config: dict[Any, Any], place: str) -> None:
    (problem,) = problems_of_values(config)
    assert problem.startswith(place)


def test_aliases_of_aliases_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plain_values, "MAX_VALUES", 1000)
    value: list[Any] = [1] * 10
    for _ in range(8):
        value = [value] * 10
    assert "more than a million values" in problems_of_values({"a": value})[0]
