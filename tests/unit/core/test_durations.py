from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.durations import readable, roughly


@given(st.floats(0, 1e6))
def test_a_readable_time_is_right_to_its_last_unit(seconds: float) -> None:
    parts = readable(seconds).split()
    total = sum(
        float(n) * {"s": 1, "min": 60, "h": 3600}[unit] for n, unit in zip(parts[::2], parts[1::2], strict=True)
    )
    assert abs(total - seconds) <= (60 if "h" in parts else 0.5 if "min" in parts else 0.05) + 1e-6


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(0, "under a minute"), (29, "under a minute"), (31, "1 min"), (850, "14 min"), (7500, "2 h 5 min")],
)
def test_an_estimate_is_said_no_finer_than_it_is(seconds: float, said: str) -> None:
    assert roughly(seconds) == said
