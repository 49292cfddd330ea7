"""Text of C: tables of numbers, each once, and names."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

#: Numbers in a line of a table.
PER_LINE = 8


class Tables:
    """The tables of one header; a table that is there already gets the same name."""

    def __init__(self, prefix: str) -> None:
        self.prefix = prefix
        self.texts: list[str] = []
        self.names: dict[tuple[str, bytes], str] = {}
        self.functions: list[str] = []

    def name(self, values: Any) -> str:
        """The name of the table of these numbers: `double`, or `int` of whole ones."""
        array = np.ascontiguousarray(values)
        is_whole = array.dtype.kind in "iub"
        array = array.astype(np.int64 if is_whole else np.float64).ravel()
        key = ("int" if is_whole else "double", array.tobytes())
        if key not in self.names:
            self.names[key] = f"{self.prefix}_t{len(self.names)}"
            words = [str(one) if is_whole else number(one) for one in array.tolist()] or ["0"]
            lines = [", ".join(words[start : start + PER_LINE]) for start in range(0, len(words), PER_LINE)]
            body = ",\n    ".join(lines)
            self.texts.append(f"static const {key[0]} {self.names[key]}[{len(words)}] = {{\n    {body}}};")
        return self.names[key]

    def function(self, arguments: str, body: str, *, what: str = "") -> str:
        """The name of a new function without a result."""
        name = f"{self.prefix}_f{len(self.functions)}"
        lines = "\n".join(f"    {line}" for line in body.strip().splitlines())
        head = f"/* {what} */\n" if what else ""
        self.functions.append(f"{head}static inline void {name}({arguments}) {{\n{lines}\n}}")
        return name


def number(value: float) -> str:
    """A number of C that reads back the same."""
    if np.isinf(value):
        return "HUGE_VAL" if value > 0 else "-HUGE_VAL"
    return repr(float(value))


def identifier(name: str) -> str:
    """A name as an identifier of C."""
    plain = re.sub(r"\W", "_", name, flags=re.ASCII)
    return plain if re.match(r"[A-Za-z]", plain) else f"robot_{plain}"
