from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.numpy_file import open_table


def test_arrays_and_tables_of_numpy_are_read(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.array([[1.0, 2.0], [3.0, 4.0]]))
    assert open_table(tmp_path / "a.npy", {}).names == ("c_1", "c_2")
    np.savez(tmp_path / "a.npz", u=np.array([1.0, 2.0]), x=np.array([[3.0], [4.0]]))
    assert open_table(tmp_path / "a.npz", {}).read([0, 1], [])[0].tolist() == [[1, 3], [2, 4]]


def test_python_objects_and_damaged_files_are_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.array([{}], dtype=object), allow_pickle=True)
    (tmp_path / "b.npz").write_bytes(b"PK\x03\x04 a.npy")
    for name, says in (("a.npy", "arrays of Python objects"), ("b.npz", "not readable as arrays")):
        with pytest.raises(DataError, match=says):
            open_table(tmp_path / name, {})


@pytest.mark.parametrize("is_dictionary", [True, False])
def test_the_two_lines_that_convert_python_objects_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_dictionary: bool
) -> None:
    monkeypatch.chdir(tmp_path)
    parts = {"u": np.arange(6.0).reshape(3, 2), "x": np.arange(3.0)}
    if is_dictionary:
        np.savez("a.npz", data=np.array(parts, dtype=object))
    else:
        np.savez("a.npz", u=parts["u"].astype(object), x=parts["x"].astype(object))
    with pytest.raises(DataError) as raised:
        open_table(Path("a.npz"), {"file": "data/a.npz"})
    lines = [line.strip() for line in str(raised.value.fix).splitlines()[1:]]
    exec("\n".join(lines), {})
    table = open_table(Path("plain.npz"), {})
    assert table.names == ("u_1", "u_2", "x")
    assert table.read(range(3), [])[0].tolist() == [[0, 1, 0], [2, 3, 1], [4, 5, 2]]
