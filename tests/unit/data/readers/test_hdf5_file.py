from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from softkin.core.errors import DataError
from softkin.data.readers.table_formats import open_table


def of_matlab(path: Path, content: dict[str, Any]) -> Path:
    """A file as MATLAB writes it from v7.3 on: a block of its own, axes turned round, trials as references."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in content.items():
            if isinstance(value, list):
                group = file.create_group(name)
                group.attrs["MATLAB_class"] = np.bytes_("struct")
                for field in value[0]:
                    references = []
                    for number, struct in enumerate(value):
                        inner = _array(file, f"#refs#/{name}{field}{number}", struct[field])
                        references.append(inner.ref)
                    group.create_dataset(field, data=np.array(references, dtype=h5py.ref_dtype)[:, None])
            elif isinstance(value, dict):
                file.create_group(name).attrs["MATLAB_class"] = np.bytes_("struct")
                for field, array in value.items():
                    _array(file, f"{name}/{field}", array)
            else:
                _array(file, name, value)
    with open(path, "r+b") as head:
        head.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124))
    return path


def _array(file: Any, name: str, value: Any) -> Any:
    is_text = isinstance(value, str)
    data = np.array([list(map(ord, value))], np.uint16) if is_text else np.atleast_2d(np.asarray(value, float))
    inner = file.create_dataset(name, data=data.T)
    inner.attrs["MATLAB_class"] = np.bytes_("char" if is_text else "double")
    return inner


def test_variables_of_matlab_are_read_with_their_axes(tmp_path: Path) -> None:
    path = of_matlab(tmp_path / "a.mat", {"u": np.arange(8.0).reshape(4, 2), "x": np.arange(4.0)[None], "who": "me"})
    table = open_table(path, {})
    assert table.names == ("u_1", "u_2", "x")
    assert table.read([0, 1, 2], [])[0].tolist() == [[0, 1, 0], [2, 3, 1], [4, 5, 2], [6, 7, 3]]


def test_structs_of_matlab_give_fields_and_trials_sessions(tmp_path: Path) -> None:
    one = of_matlab(tmp_path / "a.mat", {"arm": {"t": np.arange(3.0), "u": np.ones((3, 2))}})
    assert open_table(one, {}).names == ("t", "u_1", "u_2")
    trials = [{"t": np.arange(n), "u": np.full((n, 2), n), "rate": 50.0} for n in (3, 4)]
    table = open_table(of_matlab(tmp_path / "b.mat", {"trials": trials}), {})
    assert table.names == ("session", "t", "u_1", "u_2")
    values = table.read([0, 1, 2], [])[0]
    assert values.T.tolist() == [[1, 1, 1, 2, 2, 2, 2], [0, 1, 2, 0, 1, 2, 3], [3, 3, 3, 4, 4, 4, 4]]


def test_other_hdf5_files_are_read_as_they_are(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["u"] = np.arange(8.0).reshape(4, 2)
        file["trial"] = ["a", "a", "b", "b"]
    table = open_table(tmp_path / "a.h5", {})
    assert table.names == ("trial", "u_1", "u_2")
    values, (trial,) = table.read([1, 2], [0])
    assert values[1].tolist() == [2.0, 3.0]
    assert trial.tolist() == ["a", "a", "b", "b"]


@pytest.mark.parametrize("content", [b"MATLAB 7.3 MAT-file", b"\x89HDF\r\n\x1a\n damaged"])
def test_a_damaged_file_is_an_error(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.mat").write_bytes(content)
    with pytest.raises(DataError, match="not readable as HDF5"):
        open_table(tmp_path / "a.mat", {})
