"""Values that no key of the configuration may have: NaN, infinity, numbers beyond all measure, control characters, and
values that hold themselves.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

#: The configuration nests five deep and has some hundred values a dataset.
MAX_DEPTH = 20
MAX_VALUES = 1_000_000
MAX_LENGTH = 10_000
#: Whole numbers beyond it are no counts.
MAX_WHOLE = 2**53


def problems_of_values(config: Mapping[str, Any]) -> list[str]:
    """A line for each value, wherever it stands, that no key may have."""
    counted: list[str] = []
    for count, problem in enumerate(_walk(config, "", 0)):
        if count > MAX_VALUES:
            return ["top level: more than a million values; a YAML alias (*name) probably repeats itself"]
        if problem:
            counted.append(problem)
    return list(dict.fromkeys(counted))


def _walk(value: Any, place: str, depth: int) -> Iterator[str]:
    """The problem of each value, empty where there is none."""
    if depth > MAX_DEPTH:
        yield f"{place.split('.')[0]}: nested deeper than {MAX_DEPTH} levels; write it flat"
    elif isinstance(value, Mapping):
        for key, item in value.items():
            path = f"{place}.{key}" if place else str(key)
            if isinstance(key, str):
                yield from _walk(item, path, depth + 1)
            else:
                yield f"{place or 'top level'}: the key {key!r} is no text; write it in quotes"
    elif isinstance(value, (list, tuple)):
        for number, item in enumerate(value):
            yield from _walk(item, f"{place}.{number}", depth + 1)
    else:
        reason = _reason(value)
        yield f"{place}: {reason}" if reason else ""


def _reason(value: Any) -> str:
    if isinstance(value, float) and not math.isfinite(value):
        return f"{value} is no finite number"
    if isinstance(value, int) and abs(value) > MAX_WHOLE:
        return f"a whole number beyond {MAX_WHOLE}"
    if isinstance(value, float) and abs(value) > 1e100:
        return f"{value:g} is too large a number"
    if isinstance(value, str) and len(value) > MAX_LENGTH:
        return f"{len(value)} characters, of at most {MAX_LENGTH}"
    if isinstance(value, str) and any(ord(sign) < 32 and sign not in "\n\t" for sign in value):
        return "a control character in the text; delete it"
    return ""
