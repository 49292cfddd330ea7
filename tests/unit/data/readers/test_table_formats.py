from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import NO_TABLES, TABLE_FORMATS, open_table


@pytest.mark.parametrize("magic", NO_TABLES)
def test_what_is_no_table_is_named(tmp_path: Path, magic: bytes) -> None:
    (tmp_path / "arm").write_bytes(magic + b"\0" * 20)
    with pytest.raises(DataError, match="no table, but"):
        open_table(tmp_path / "arm", {})


def test_the_first_bytes_decide_and_not_the_name(tmp_path: Path) -> None:
    (tmp_path / "arm.parquet").write_text("u1,x\n1,2\n3,4\n")
    assert open_table(tmp_path / "arm.parquet", {}).names == ("u1", "x")
    assert list(TABLE_FORMATS)[-1] == "text"
