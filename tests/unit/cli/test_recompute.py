from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from softkin.cli.recompute import COLLECTED, recomputed
from tests.unit.cli.results import write_results


@pytest.fixture
def results(tmp_path: Path) -> Path:
    write_results(tmp_path / "results")
    return tmp_path / "results"


def edit(path: Path, column: str, row: int = 0) -> None:
    """Add a thousandth to a number of a table."""
    frame = pd.read_csv(path) if path.suffix == ".csv" else pd.read_parquet(path)
    frame[column] = frame[column].astype(float)
    frame.iloc[row, frame.columns.get_loc(column)] += 0.001
    frame.to_csv(path, index=False) if path.suffix == ".csv" else frame.to_parquet(path)


def test_tables_are_what_the_stored_predictions_give(results: Path) -> None:
    assert list(recomputed(results)) == []


@pytest.mark.parametrize(
    ("file", "column", "says"),
    [
        ("arm/point_metrics.csv", "rmse_mm", "point_metrics.csv, row 1, column rmse_mm"),
        ("arm/marker_errors.csv", "euclidean_mean_mm", "marker_errors.csv, row 1, column euclidean_mean_mm"),
        (
            "arm/interval_metrics.csv",
            "coverage",
            "intervals give: scp around lr paper, test, m1_x",
        ),
        (
            "arm/intervals/scp.parquet",
            "upper_m1_y",
            "intervals give: scp around lr paper, test, m1_y",
        ),
        ("arm/lr/paper/predictions.parquet", "m1_x", "point_metrics.csv, row 1"),
        ("tables/point_metrics.csv", "rmse_mm", "tables/point_metrics.csv, row 1, column rmse_mm"),
        ("tables/interval_metrics.csv", "winkler_mm", "tables/interval_metrics.csv, row 1, column winkler_mm"),
    ],
)
def test_one_edited_number_is_named(results: Path, file: str, column: str, says: str) -> None:
    edit(results / file, column)
    found = list(recomputed(results))
    assert any(says in sentence for sentence in found), found


def test_a_table_that_is_cut_or_unreadable_is_named(results: Path) -> None:
    lines = (results / "tables" / "point_metrics.csv").read_text().splitlines()
    (results / "tables" / "point_metrics.csv").write_text("\n".join(lines[:4]))
    (results / "arm" / "interval_metrics.csv").write_bytes(b"\x00\xff")
    found = list(recomputed(results))
    assert any("has 3 rows, and its sources give 8" in sentence for sentence in found)
    assert any("interval_metrics.csv" in sentence for sentence in found)
    (results / "arm" / "lr" / "paper" / "predictions.parquet").unlink()
    assert any("cannot be checked" in sentence for sentence in recomputed(results))


def test_collected_tables_are_files_of_a_dataset() -> None:
    """Names that the rules know."""
    rules = (Path(__file__).parents[3] / "workflow" / "rules" / "score.smk").read_text()
    for name in COLLECTED:
        assert f"/{name}.csv" in rules
