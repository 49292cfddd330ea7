from __future__ import annotations

import math

import pytest

from softkin.reporting.tables.numbers import length_text, number_text, share_text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (2.8912, "2.89"),
        (114.73, "115"),
        (1234.5, "1234"),
        (0.0004123, "0.000412"),
        (5.38e-7, "0.000000538"),
        (-6.678, "-6.68"),
        (-0.0481, "-0.0481"),
        (0.0, "0"),
        (1e-13, "<0.000000001"),
        (-1e-13, ">-0.000000001"),
        (math.inf, "infinite"),
        (-math.inf, "-infinite"),
        (math.nan, "–"),
        (None, "–"),
    ],
)
def test_three_digits_and_no_exponent(value: float | None, text: str) -> None:
    assert number_text(value) == text


@pytest.mark.parametrize("exponent", range(-9, 7))
def test_a_number_keeps_its_size(exponent: int) -> None:
    value = 3.14159 * 10.0**exponent
    text = number_text(value)
    assert "e" not in text
    assert float(text) == pytest.approx(value, rel=5e-3)


@pytest.mark.parametrize(("value", "text"), [(0.9144, "91.4 %"), (1.0, "100.0 %"), (math.nan, "–"), (None, "–")])
def test_shares(value: float | None, text: str) -> None:
    assert share_text(value) == text


def test_a_level_has_no_decimals() -> None:
    assert share_text(0.9, 0) == "90 %"


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.5094, "0.509 mm"), (1e-6, "0.00000100 mm"), (9.9e-7, "below a nanometre"), (math.nan, "– mm")],
)
def test_lengths(value: float, text: str) -> None:
    assert length_text(value) == text
