from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.core.run_archive import CPU_SECONDS, RunArchive, read_run_archive
from softkin.core.runs import OUTER, PAPER, TUNED, Run


def archive() -> RunArchive:
    rng = np.random.default_rng(0)
    arrays = {
        (Run("svr", TUNED), "test"): rng.standard_normal((4, 3)),
        (Run("svr", PAPER), "test"): rng.standard_normal((2, 3)),
        (Run("gp", OUTER), "core 0.7"): rng.standard_normal((1, 5, 3)),
        (Run("gp", OUTER), "train"): rng.standard_normal((0, 3)),
    }
    return RunArchive({"rows": np.arange(5), CPU_SECONDS: np.array(1.5)}, arrays)


def test_arrays_come_back_to_the_bit_under_their_names(tmp_path: Path) -> None:
    archive().write(tmp_path / "deep" / "refits.npz")
    back = read_run_archive(tmp_path / "deep" / "refits.npz")
    assert list(back.of_runs) == list(archive().of_runs)
    assert all(isinstance(run, Run) for run, _ in back.of_runs)
    for name, array in archive().of_runs.items():
        np.testing.assert_array_equal(back.of_runs[name], array)
    assert set(back.shared) == {"rows", CPU_SECONDS}
    np.testing.assert_array_equal(back.shared["rows"], np.arange(5))
    assert float(back.shared[CPU_SECONDS]) == 1.5


@pytest.mark.parametrize("shared", [{}, {"rows": np.arange(3)}])
def test_an_archive_without_runs_comes_back(tmp_path: Path, shared: dict[str, np.ndarray]) -> None:
    RunArchive(shared).write(tmp_path / "refits.npz")
    back = read_run_archive(tmp_path / "refits.npz")
    assert back.of_runs == {}
    assert set(back.shared) == set(shared)


def test_no_file_is_an_empty_archive() -> None:
    assert read_run_archive(None) == RunArchive()


def test_an_archive_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    archive().write(tmp_path / "refits.npz")
    before = (tmp_path / "refits.npz").read_bytes()
    monkeypatch.setattr(np, "savez_compressed", lambda file, **_: file.write(b"half") and 1 / 0)
    with pytest.raises(ZeroDivisionError):
        archive().write(tmp_path / "refits.npz")
    assert (tmp_path / "refits.npz").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["refits.npz"]
