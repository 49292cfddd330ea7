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
    for name in ("a.npy", "b.npz"):
        with pytest.raises(DataError, match="not readable as arrays"):
            open_table(tmp_path / name, {})
