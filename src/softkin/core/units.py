"""Units of positions: lengths, which become mm, and a unit of one's own, such as pixels, which stays as it is."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any

MM = "mm"
#: Lengths that a dataset's entry may name; positions in them are in mm in every table.
MM_PER_UNIT = {"m": 1000.0, "cm": 10.0, MM: 1.0, "in": 25.4}
#: Lengths that people write, and which of ours is meant; None: none of ours is.
LENGTHS: dict[str, str | None] = {
    **dict.fromkeys(("metre", "metres", "meter", "meters"), "m"),
    **dict.fromkeys(("centimetre", "centimetres", "centimeter", "centimeters"), "cm"),
    **dict.fromkeys(("millimetre", "millimetres", "millimeter", "millimeters"), MM),
    **dict.fromkeys(("inch", "inches"), "in"),
    **dict.fromkeys(("ft", "foot", "feet", "yd", "yard", "yards", "mil", "mils", "km", "dm", "nm", "um", "µm")),
    **dict.fromkeys(("micron", "microns", "micrometre", "micrometer")),
}
#: A unit of one's own: a short word.
NAME = re.compile(r"[^\W\d_][\w%/^.-]{0,15}")
#: A length in a sentence: what stands behind its number.
IN_SENTENCE = re.compile(r"(?<=\d )mm\b")


def reason_against(unit: str) -> str:
    """Why a dataset's entry may not name this unit of its positions, with what to write; empty where it may."""
    if unit in MM_PER_UNIT:
        return ""
    ours = ", ".join(MM_PER_UNIT)
    small = unit.lower()
    near = get_close_matches(small, MM_PER_UNIT, n=1, cutoff=0.7)
    if small in LENGTHS or near:
        meant = LENGTHS.get(small) or next(iter(near), None)
        question = "; bring positions to one of them" if meant is None else f"; did you mean '{meant}'?"
        return f"'{unit}' is none of {ours}{question}"
    if NAME.fullmatch(unit):
        return ""
    return f"'{unit}' is none of {ours}, and no name of a unit of your own; write a short word such as px"


def unit_in_tables(position_unit: str) -> str:
    """The unit that positions have in tables: mm of a length, else the unit of one's own."""
    return MM if position_unit in MM_PER_UNIT else position_unit


def per_unit(position_unit: str) -> float:
    """What positions are multiplied by to be in the unit of tables."""
    return MM_PER_UNIT.get(position_unit, 1.0)


def unit_of(described: Mapping[str, Any]) -> str:
    """The unit of positions, errors and widths of a dataset, from its description or what a calibrated model knows.

    Both have a key `unit` where that is not mm. Names of columns and metrics such as `rmse_mm` are the same for all.
    """
    return str(described.get("unit", MM))


def own_unit(unit: str) -> dict[str, str]:
    """The key `unit` of a description: none of mm."""
    return {} if unit == MM else {"unit": unit}


def heading(units: Iterable[str]) -> str:
    """What heads a column of several datasets: their common unit, or all of them: 'mm or px'."""
    return " or ".join(sorted(set(units), key=lambda unit: (unit != MM, unit))) or MM


def in_unit(sentence: str, unit: str) -> str:
    """The sentence with its lengths, such as '0.3 mm', in the unit."""
    return sentence if unit == MM else IN_SENTENCE.sub(lambda _: unit, sentence)
