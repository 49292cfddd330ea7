from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from softkin.core.strict_json import MAX_DEPTH, NotStrictJson, parse_json

SCALARS = st.none() | st.booleans() | st.integers(-(10**20), 10**20) | st.floats(allow_nan=False, allow_infinity=False)
VALUES = st.recursive(
    SCALARS | st.text(), lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner), max_leaves=20
)


@settings(max_examples=50)
@given(VALUES)
def test_what_is_strict_comes_back(value: object) -> None:
    assert parse_json(json.dumps(value)) == value


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "empty"),
        ('{"a": [1, 2', "cut off"),
        ("{]", "line 1 column 2"),
        ('{"a": 1, "a": 1}', "'a' stands twice"),
        ("[NaN]", "NaN"),
        ("[1e400]", "1e400"),
        ("9" * 5000, "5000 digits"),
        ("[" * 100_000, "deeply"),
        ("[" * (MAX_DEPTH + 1) + "]" * (MAX_DEPTH + 1), "deeply"),
    ],
)
def test_what_is_not_says_why(text: str, says: str) -> None:
    with pytest.raises(NotStrictJson, match=says):
        parse_json(text)


def test_as_deep_as_it_may_be() -> None:
    assert parse_json("[" * MAX_DEPTH + "]" * MAX_DEPTH)
