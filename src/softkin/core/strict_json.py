"""JSON read strictly: what the standard library lets through, or answers with an error of its own, has one message."""

from __future__ import annotations

import json
import math
from typing import Any

#: Files of softkin nest five deep.
MAX_DEPTH = 50
#: A whole number of more digits fits into no 64-bit float.
MAX_DIGITS = 300


class NotStrictJson(ValueError):
    """The text is no JSON, or JSON that cannot be trusted to mean one thing; its message says why, and where."""


def parse_json(text: str, *, any_number: bool = False) -> Any:
    """The value of a JSON text. With `any_number`, NaN is let through, and infinity for numbers beyond 64-bit floats:
    who reads them can say where they stand.

    Raises:
        NotStrictJson: no JSON; a key twice in an object; NaN, or a number beyond 64-bit floats; nested too deeply.
    """
    try:
        numbers: dict[str, Any] = {"parse_int": _any_integer} if any_number else _STRICT
        value = json.loads(text, object_pairs_hook=_unique, **numbers)
    except json.JSONDecodeError as error:
        at_end = error.pos >= len(text.rstrip())
        cut = "; the file ends there, so it was probably cut off" if at_end and text.strip() else ""
        reason = "it is empty" if not text.strip() else f"{error.msg}, line {error.lineno} column {error.colno}{cut}"
        raise NotStrictJson(f"not JSON: {reason}") from error
    except RecursionError as error:
        raise NotStrictJson("nested too deeply") from error
    if _is_deeper(value, MAX_DEPTH):
        raise NotStrictJson("nested too deeply")
    return value


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    value = dict(pairs)
    if len(value) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise NotStrictJson(f"the key '{twice[:60]}' stands twice in one object")
    return value


def _constant(name: str) -> Any:
    raise NotStrictJson(f"{name}, which is no JSON number")


def _float(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise NotStrictJson(f"too large a number: {text[:40]}")
    return value


def _integer(text: str) -> int:
    if len(text) > MAX_DIGITS:
        raise NotStrictJson(f"too large a number: {text[:20]}... ({len(text)} digits)")
    return int(text)


def _any_integer(text: str) -> int | float:
    return int(text) if len(text) <= MAX_DIGITS else float(text)


_STRICT: dict[str, Any] = {"parse_constant": _constant, "parse_float": _float, "parse_int": _integer}


def _is_deeper(value: Any, depth: int) -> bool:
    """Whether lists and objects stand in each other deeper than that, found level by level."""
    level = [value] if isinstance(value, (dict, list)) else []
    for _ in range(depth):
        inner = [item for outer in level for item in (outer.values() if isinstance(outer, dict) else outer)]
        level = [item for item in inner if isinstance(item, (dict, list))]
    return bool(level)
