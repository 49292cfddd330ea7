from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.cli.guess_entry import guess_entry
from softkin.cli.guess_split import restarts_of
from softkin.data.readers import table_file
from tests.unit.cli.tables import columns

N = 120


def guess(folder: Path, table: pd.DataFrame, **options: Any) -> tuple[dict[str, Any], str]:
    """The entry, which reads the file, and what is said."""
    table.to_csv(folder / "arm.csv", index=False)
    entry, reasons = guess_entry(folder / "arm.csv", "Arm", "arm.csv", options)
    table_file.read(folder / "arm.csv", dataset="arm", source=entry)
    return entry, "; ".join(reasons)


def recording(**more: Any) -> pd.DataFrame:
    """Commands that follow each other."""
    phase = np.linspace(0, 9, N)
    told = {"u1": np.sin(phase), "u2": np.cos(1.7 * phase)}
    moved = {axis: np.sin(phase + shift) * 40 for shift, axis in enumerate("xyz", 1)}
    return pd.DataFrame(more | told | moved)


def test_few_trials_of_a_file_are_sessions(tmp_path: Path) -> None:
    table = columns("u1", "u2", "x", "y", "z")[:N]
    entry, said = guess(tmp_path, table.assign(trial=np.repeat(["a", "b", "c"], N // 3)))
    assert entry["split"] == {"method": "session"}
    assert "too few to draw from" in said
    assert guess(tmp_path, table.assign(trial=np.repeat([*"abcd"], N // 4)))[0]["split"]["method"] == "group"


def test_rows_that_are_alike_are_never_split_at_random(tmp_path: Path) -> None:
    entry, said = guess(tmp_path, recording())
    assert entry["split"] == {"method": "time"}
    assert "order of the file" in said
    entry, said = guess(tmp_path, recording(stopwatch=np.arange(N) / 30 + 1))
    assert (entry["order"], entry["split"]) == ("stopwatch", {"method": "later"})
    assert "grows from row to row" in said


@pytest.mark.parametrize("shift", [0.0, 0.013])
def test_a_time_that_starts_again_does_not_mix_what_came_before_and_after(tmp_path: Path, shift: float) -> None:
    time = np.r_[np.arange(70) / 10, np.arange(N - 70) / 10 + shift]
    entry, said = guess(tmp_path, recording(t=time))
    assert entry["split"] == {"method": "time"}
    assert "order" not in entry
    assert "starts again" in said


def test_rows_in_no_order_do_not_start_again() -> None:
    rng = np.random.default_rng(0)
    assert restarts_of(rng.permutation(N)) == []
    assert restarts_of(np.arange(N)) == []
    assert restarts_of(np.r_[np.arange(60), np.arange(60)]) == [60]
    jitter = np.arange(N, dtype=float)
    jitter[[50, 51]] = jitter[[51, 50]]
    assert restarts_of(jitter) == []
    assert restarts_of(np.array(["a", "b"], dtype=object)) == []
