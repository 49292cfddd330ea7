from __future__ import annotations

from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.core.damage import check_ends, first_damage
from softkin.core.errors import DataError
from softkin.core.files import write_json
from softkin.core.run_archive import RunArchive


@pytest.fixture
def results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """One sound file of each kind, below results/ of the working directory."""
    monkeypatch.chdir(tmp_path)
    folder = Path("results/arm")
    folder.mkdir(parents=True)
    frame = pd.DataFrame({"a": [1.0, np.nan], "b": ["x, y", "line\nbreak"]})
    frame.to_csv(folder / "a.csv", index=False)
    frame.to_csv(folder / "a.tsv", sep="\t", index=False)
    frame.to_parquet(folder / "a.parquet")
    write_json(folder / "a.json", {"a": None})
    RunArchive({"a": np.arange(3.0)}).write(folder / "a.npz")
    joblib.dump(np.arange(3.0), folder / "a.joblib", compress=3)
    (folder / "raw").write_bytes(b"whatever")
    return sorted(folder.iterdir())


def test_sound_files_are_sound(results: list[Path]) -> None:
    check_ends(results)
    assert first_damage([*results, "results/arm/absent.csv", "results/arm"]) is None


@pytest.mark.parametrize("suffix", ["csv", "tsv", "parquet", "json", "npz", "joblib"])
def test_the_damaged_one_among_sound_ones_is_named(results: list[Path], suffix: str) -> None:
    path = Path(f"results/arm/a.{suffix}")
    path.write_bytes(path.read_bytes()[:-20])
    error = first_damage(results)
    if error is None:  # a table that is cut off between two rows' values ends without a line break
        with pytest.raises(DataError, match=f"a.{suffix}: this result is damaged"):
            check_ends(results)
    else:
        assert error.where == str(path)


class Program:
    """Unpickling it makes a file."""

    def __reduce__(self) -> tuple[Any, tuple[Path]]:
        return Path.touch, (Path("it_ran"),)


@pytest.mark.parametrize("compress", [0, 3])
def test_looking_for_damage_runs_nothing_of_a_model(results: list[Path], compress: int) -> None:
    joblib.dump(Program(), "results/arm/a.joblib", compress=compress)
    first_damage(results)
    assert not Path("it_ran").exists()


@pytest.mark.parametrize("cut", [1, 4, 20])
def test_a_model_that_is_cut_off_anywhere_is_named(results: list[Path], cut: int) -> None:
    path = Path("results/arm/a.joblib")
    path.write_bytes(path.read_bytes()[:-cut])
    error = first_damage(results)
    assert error is not None
    assert "it holds no whole model" in str(error)


def test_only_results_must_end_with_a_line_break(results: list[Path]) -> None:
    own = Path("robot.csv")
    own.write_text("a,b\n1,2")
    check_ends([own])
    results[0].write_text("a,b\n1,2")
    with pytest.raises(DataError, match="cut off or empty"):
        check_ends(results)
