from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from softkin.core.errors import DataError
from softkin.data.readers.matlab_file import open_table


def test_trials_become_sessions(tmp_path: Path) -> None:
    trials = np.empty(2, dtype=object)
    for place, rows in enumerate((3, 4)):
        trials[place] = {"t": np.arange(rows), "u": np.full((rows, 2), place), "rate": 50.0}
    savemat(tmp_path / "a.mat", {"trials": trials})
    table = open_table(tmp_path / "a.mat", {})
    assert table.names == ("session", "t", "u_1", "u_2")
    assert table.read([0, 1], [])[0].T.tolist() == [[1, 1, 1, 2, 2, 2, 2], [0, 1, 2, 0, 1, 2, 3]]


@pytest.mark.parametrize(
    ("content", "says"), [(b"MATLAB 5.0", "not readable"), (b"MATLAB 5.0 MAT-file" + b" " * 200, "not readable")]
)
def test_what_cannot_be_read_is_an_error(tmp_path: Path, content: bytes, says: str) -> None:
    (tmp_path / "a.mat").write_bytes(content)
    with pytest.raises(DataError, match=says):
        open_table(tmp_path / "a.mat", {})
