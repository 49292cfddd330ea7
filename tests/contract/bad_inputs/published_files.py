"""Files that are not what the published ones are."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from softkin.core.samples import SUBSETS
from tests.conftest import four_subsets, published_json
from tests.contract.bad_inputs.case import BadInput, prepared

ENTRY = {"format": "kinn_json", "position_unit": "mm", "n_commands": 2, "n_markers": 1}
GOOD = json.dumps(published_json(four_subsets(dict.fromkeys(SUBSETS, 120))))
NUMBER = '"motor_control": [['


def text(content: str | bytes, **entry: Any) -> Callable[[], None]:
    return prepared(content, {**ENTRY, **entry})


def changed(change: Callable[[Any], object], **entry: Any) -> Callable[[], None]:
    """A good file with one change."""

    def provoke() -> None:
        content = json.loads(GOOD)
        change(content)
        text(json.dumps(content), **entry)()

    return provoke


def first(value: str) -> Callable[[], None]:
    """A good file, with this text as its first number."""
    start = GOOD.index(NUMBER) + len(NUMBER)
    return text(GOOD[:start] + value + GOOD[GOOD.index(",", start) :])


def never_moves(content: Any) -> None:
    for rows in content.values():
        rows["position"] = [rows["position"][0]] * len(rows["position"])


def one_command(content: Any) -> None:
    for rows in content.values():
        rows["motor_control"] = [rows["motor_control"][0]] * len(rows["motor_control"])


ROW = ("subset 'train'", "row 0")
CASES = [
    BadInput("an empty file", text(""), ("not JSON", "empty")),
    BadInput("a file cut off", text(GOOD[: len(GOOD) // 2]), ("not JSON", "cut off")),
    BadInput("a page of HTML", text("<html>404</html>"), ("not JSON", "line 1")),
    BadInput("zero bytes", text(b"\0" * 100), ("not JSON",)),
    BadInput("text in Latin-1", text("ü".encode("latin-1")), ("not JSON", "utf-8")),
    BadInput("a list", text("[]"), ("expected an object", "train, val, test, ext")),
    BadInput("nested 100,000 deep", text("[" * 100_000 + "]" * 100_000), ("nested too deeply",)),
    BadInput("nested 100,000 deep and cut off", text('{"train":' * 100_000), ("nested too deeply",)),
    BadInput("a key twice", text(GOOD[:-1] + ', "train": {}}'), ("'train'", "stands twice")),
    BadInput("a number of 5,000 digits", first("9" * 5000), (*ROW, "not finite: inf")),
    BadInput("a whole number of 400 digits", first("9" * 400), (*ROW, "not finite: inf")),
    BadInput("a whole number of 200 digits", first("9" * 200), (*ROW, "too large a number")),
    BadInput("a number of 1e308", first("1e308"), (*ROW, "too large a number: 1e+308")),
    BadInput("a number beyond floats", first("1e999"), (*ROW, "not finite: inf")),
    BadInput("NaN", first("NaN"), (*ROW, "not finite: nan")),
    BadInput("-Infinity", first("-Infinity"), (*ROW, "not finite: -inf")),
    BadInput("null in place of a number", first("null"), (*ROW, "expected a number, not null")),
    BadInput("true in place of a number", first("true"), (*ROW, "expected a number, not true")),
    BadInput("a number in quotes", first('"1"'), (*ROW, 'expected a number, not "1"')),
    BadInput("no subset val", changed(lambda c: c.pop("val")), ("subset 'val'", "missing")),
    BadInput("a subset that is a list", changed(lambda c: c.update(ext=[])), ("subset 'ext'", "not an object")),
    BadInput("no positions", changed(lambda c: c["test"].pop("position")), ("field 'position'", "missing")),
    BadInput("an empty subset", changed(lambda c: c["test"].update(motor_control=[])), ("no rows",)),
    BadInput("a row less", changed(lambda c: c["test"]["position"].pop()), ("different length", "subset 'test'")),
    BadInput("a coordinate less", changed(lambda c: c["test"]["position"][5][0].pop()), ("row 5", "3 values")),
    BadInput("another number of commands", changed(lambda _: None, n_commands=3), ("expected 3 values",)),
    BadInput("another number of markers", changed(lambda _: None, n_markers=2), ("expected 2 values",)),
    BadInput("other rows than registered", changed(lambda _: None, rows={"test": 7}), ("120 rows", "registers 7")),
    BadInput(
        "four rows of validation",
        changed(lambda c: [rows.__delitem__(slice(4, None)) for rows in c["val"].values()]),
        ("validation gets 4 of at least 5",),
    ),
    BadInput("positions that never move", changed(never_moves), ("never move",)),
    BadInput("one command alone", changed(one_command), ("distinct command",)),
]
