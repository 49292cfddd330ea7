from __future__ import annotations

import pytest

from softkin.core.units import (
    MM_PER_UNIT,
    heading,
    in_unit,
    own_unit,
    per_unit,
    reason_against,
    unit_in_tables,
    unit_of,
)


@pytest.mark.parametrize("unit", [*MM_PER_UNIT, "px", "pixels", "counts", "deg"])
def test_lengths_and_short_words_are_units(unit: str) -> None:
    assert reason_against(unit) == ""


@pytest.mark.parametrize(
    ("unit", "says"),
    [
        ("inch", "did you mean 'in'?"),
        ("Metres", "did you mean 'm'?"),
        ("MM", "did you mean 'mm'?"),
        ("mmm", "did you mean 'mm'?"),
        ("µm", "bring positions to one of them"),
        ("feet", "bring positions to one of them"),
        ("", "write a short word such as px"),
        ("5", "write a short word such as px"),
        ("p\nx", "write a short word such as px"),
        ("the pixels of our camera", "write a short word such as px"),
    ],
)
def test_other_lengths_and_what_is_no_word_are_refused(unit: str, says: str) -> None:
    assert f"'{unit}' is none of m, cm, mm, in" in reason_against(unit)
    assert says in reason_against(unit)


def test_lengths_become_mm_and_a_unit_of_ones_own_stays() -> None:
    assert [per_unit(unit) for unit in ("in", "px")] == [25.4, 1.0]
    assert [unit_in_tables(unit) for unit in ("in", "px")] == ["mm", "px"]
    assert [own_unit(unit) for unit in ("mm", "px")] == [{}, {"unit": "px"}]
    assert [unit_of(described) for described in ({}, {"unit": "px"})] == ["mm", "px"]


def test_a_column_is_headed_by_all_units_in_it() -> None:
    assert [heading(units) for units in ([], ["mm", "mm"], ["px"], ["px", "mm", "px"])] == [
        "mm",
        "mm",
        "px",
        "mm or px",
    ]


def test_lengths_in_a_sentence_are_in_the_unit_and_names_stay() -> None:
    sentence = "'tip mm' is 0.3 mm off, (x mm)"
    assert in_unit(sentence, "mm") == sentence
    assert in_unit(sentence, "px") == "'tip mm' is 0.3 px off, (x mm)"
