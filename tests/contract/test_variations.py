"""One robot, written in all the ways that people and programs write tables: it is read as it is, or one message says
where and how to fix it; nothing is ever changed without a word.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from softkin.core.errors import DataError
from softkin.data.readers import table_file
from tests.conftest import bending_arm

ROWS = bending_arm(100, n_commands=2, n_markers=1, seed=3)
VALUES = np.round(np.hstack([ROWS.commands, ROWS.positions]), 6)
NAMES = ["p1 größe", "p2", "x", "y", "z"]
PREAMBLES = ("", "Log of 2024-05-31\n", "limb,length\n3,0.1\n\n", "\n\n", "# by the lab\n% twice\n")
UNITS = ("bar", "bar", "mm", "mm", "mm")


@dataclass(frozen=True)
class Way:
    """How a table is written."""

    delimiter: str
    decimal: str
    encoding: str
    line_end: str
    preamble: str
    header: str
    has_units: bool
    quoted: bool
    index: bool

    def text(self, values: Any) -> str:
        quote = '"' if self.quoted else ""
        names = [name.replace(" ", "_") if self.delimiter == " " else name for name in NAMES]
        lines = []
        if self.header != "none":
            sign = "# " if self.header == "comment" else ""
            lines.append(sign + self.delimiter.join([*["row"] * self.index, *(f"{quote}{n}{quote}" for n in names)]))
        if self.has_units:
            lines.append(self.delimiter.join([*["-"] * self.index, *UNITS]))
        for row, numbers in enumerate(values.tolist()):
            cells = [f"{quote}{repr(number).replace('.', self.decimal)}{quote}" for number in numbers]
            lines.append(self.delimiter.join([*[str(row)] * self.index, *cells]))
        return self.preamble.replace("\n", self.line_end) + self.line_end.join([*lines, ""])

    def chosen(self) -> dict[str, Any]:
        """The keys of the entry."""
        if self.header == "none":
            first = 1 + self.index
            columns = [f"c{place}" for place in range(first, first + 5)]
            return {"commands": columns[:2], "positions": columns[2:], "header": "none"}
        names = [name.replace(" ", "_") if self.delimiter == " " else name for name in NAMES]
        return {"commands": names[:2], "positions": names[2:]}


WAYS = st.builds(
    Way,
    delimiter=st.sampled_from(",;\t| "),
    decimal=st.sampled_from(".,"),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "latin-1", "cp1252"]),
    line_end=st.sampled_from(["\n", "\r\n"]),
    preamble=st.sampled_from(PREAMBLES),
    header=st.sampled_from(["plain", "plain", "comment", "none"]),
    has_units=st.booleans(),
    quoted=st.booleans(),
    index=st.booleans(),
)


def read(path: Path, **keys: Any) -> Any:
    """All rows of a table, sorted."""
    entry = {"file": "arm.csv", "position_unit": "mm", "split": {"method": "random"}}
    subsets = table_file.read(path, dataset="arm", source=entry | keys)
    rows = np.vstack([np.hstack([rows.commands, rows.positions]) for rows in subsets.values()])
    return rows[np.lexsort(rows.T)]


@settings(max_examples=40, deadline=None)
@given(way=WAYS, order=st.permutations(range(len(VALUES))))
def test_a_table_is_read_as_it_is_or_a_message_says_why_not(
    tmp_path_factory: pytest.TempPathFactory, way: Way, order: list[int]
) -> None:
    path = tmp_path_factory.mktemp("way") / "arm.csv"
    path.write_bytes(way.text(VALUES[order]).encode(way.encoding))
    rows, refused = None, None
    try:
        rows = read(path, **way.chosen())
    except DataError as error:
        refused = error
    if refused is not None:
        assert refused.where
        assert refused.fix
        return
    np.testing.assert_array_equal(rows, VALUES[np.lexsort(VALUES.T)])


@pytest.mark.parametrize("delimiter", [",", ";", "\t", "|", " "])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("preamble", PREAMBLES)
def test_usual_ways_are_read(tmp_path: Path, delimiter: str, encoding: str, preamble: str) -> None:
    ways = [("plain", False), ("plain", True), *[("comment", False)] * (preamble.strip("\n")[:1] in ("", "#"))]
    for header, has_units in ways:
        way = Way(delimiter, ".", encoding, "\n", preamble, header, has_units, False, False)
        (tmp_path / "arm.csv").write_bytes(way.text(VALUES).encode(encoding))
        np.testing.assert_array_equal(read(tmp_path / "arm.csv", **way.chosen()), VALUES[np.lexsort(VALUES.T)])


@settings(max_examples=15, deadline=None)
@given(
    kind=st.sampled_from(["parquet", "feather", "npz", "json", "jsonl", "mat"]),
    order=st.permutations(range(len(VALUES))),
)
def test_other_kinds_of_files_give_the_same_rows(
    tmp_path_factory: pytest.TempPathFactory, kind: str, order: list[int]
) -> None:
    path = tmp_path_factory.mktemp("kind") / "arm"
    names = ["p1", *NAMES[1:]]
    frame = pd.DataFrame(VALUES[order], columns=names)
    if kind == "npz":
        content = io.BytesIO()
        np.savez(content, **{name: frame[name].to_numpy() for name in names})
        path.write_bytes(content.getvalue())
    elif kind == "mat":
        from scipy.io import savemat

        savemat(path, {name: frame[name].to_numpy() for name in names}, appendmat=False)
    elif kind in ("json", "jsonl"):
        frame.to_json(path, orient="records", lines=kind == "jsonl", double_precision=15)
    else:
        getattr(frame, f"to_{kind}")(path)
    rows = read(path, commands=names[:2], positions=names[2:])
    np.testing.assert_array_equal(rows, VALUES[np.lexsort(VALUES.T)])
