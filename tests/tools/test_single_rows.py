"""What `make single-rows` prints of a finished run."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.files import write_json
from softkin.core.samples import SUBSETS, coordinate_columns
from softkin.data.table import to_table, write_table
from tests.conftest import four_subsets
from tools.finished_run import FinishedRun
from tools.single_rows import left_out_of, main, numbers


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """A robot with one gross error in `test`, of its deployed run."""
    samples, folder = four_subsets(dict.fromkeys(SUBSETS, 40)), tmp_path / "arm"
    (folder / "gp" / "tuned").mkdir(parents=True)
    (folder / "intervals").mkdir()
    write_table(to_table(samples), folder / "table.parquet")
    frames, bounds = [], []
    for subset, rows in samples.items():
        guess = rows.positions + 1.0
        guess[7] += 50.0 * (subset == "test")
        frames.append(pd.DataFrame(guess, columns=coordinate_columns(1)).assign(subset=subset))
        around = np.stack([guess - 2.0, guess + 2.0], axis=-1)
        bounds.append(bounds_frame(around, subset, 0.9).assign(model="gp", preset="tuned"))
    pd.concat(frames).to_parquet(folder / "gp" / "tuned" / "predictions.parquet")
    pd.concat(bounds).to_parquet(folder / "intervals" / "scp_mapie.parquet")
    run = {"dataset": "arm", "model": "gp", "preset": "tuned", "deployed": True}
    choice = run | {"interval_method": "scp_mapie", "chosen": True, "confidence_level": 0.9, "test_coverage": 0.9}
    choice |= {"test_winkler_without_gross_mm": 1.0, "winkler_ratio_to_paper_without_gross": 1.0}
    choice |= {"test_winkler_mm": 1.0, "winkler_ratio_to_paper": 1.0}
    pd.DataFrame([choice]).drop(columns="dataset").to_csv(folder / "interval_choice.csv", index=False)
    (tmp_path / "tables").mkdir()
    tables = {"selection": run | {"target_space": "cartesian"}, "interval_choice": choice}
    for name, row in tables.items():
        pd.DataFrame([row]).to_csv(tmp_path / "tables" / f"{name}.csv", index=False)
    write_json(folder / "dataset.json", {"dataset": "arm", "title": "ARM"})
    write_json(folder / "data_card.json", {"findings": []})
    return tmp_path


def test_numbers_that_hang_on_one_row_are_listed_with_it(results: Path) -> None:
    run = FinishedRun(results)
    rows = numbers(run, left_out_of(run), 0.05)
    assert {tuple(row[:2]) for row in rows} == {("arm", "test")}
    assert {row[4] for row in rows if not row[2].startswith("r2")} == {"row 7"}
    of_rmse = next(row for row in rows if row[2] == "rmse_mm gp tuned")
    assert of_rmse[5] == "1.00"
    assert any(row[2] == "winkler_mm scp_mapie around gp tuned" for row in rows)


def test_a_run_without_tables_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", ["single_rows", "--results", str(tmp_path)])
    assert main() == 2
    assert "no such table" in capsys.readouterr().err
