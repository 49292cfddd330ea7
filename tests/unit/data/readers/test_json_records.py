from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.json_records import open_table


@pytest.mark.parametrize(
    "text",
    [
        '[{"u": 1, "x": [2, 3]}, {"u": 4, "x": [5, 6]}]',
        '{"u": 1, "x": [2, 3]}\n{"u": 4, "x": [5, 6]}\n',
        '{"u": [1, 4], "x": [[2, 3], [5, 6]]}',
    ],
)
def test_records_lines_and_columns_are_read(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.json").write_text(text)
    table = open_table(tmp_path / "a.json", {})
    assert table.names == ("u", "x1", "x2")
    assert table.read([0, 1, 2], [])[0].tolist() == [[1, 2, 3], [4, 5, 6]]


@pytest.mark.parametrize(
    "text", ["{", "[]", "3", '{"u": [1], "x": [1, 2]}', '{"train": 1, "val": 1, "test": 1, "ext": 1}']
)
def test_anything_else_is_an_error_with_its_fix(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(DataError) as error:
        open_table(tmp_path / "a.json", {})
    assert error.value.fix


def test_the_bad_line_of_lines_is_named(tmp_path: Path) -> None:
    (tmp_path / "a.jsonl").write_text('{"u": 1, "x": 2}\n{"u": 1, "x": }\n')
    with pytest.raises(DataError, match="line 2: Expecting value"):
        open_table(tmp_path / "a.jsonl", {})
