"""Scores with one row or coordinate left out."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.metrics.interval import winkler_scores
from softkin.core.metrics.point import rmse_mm
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, Array, coordinate_columns
from softkin.data.table import to_table, write_table
from softkin.evaluation.score_left_out import COLUMNS, score_left_out
from tests.conftest import four_subsets

GROSS, OTHER = 7, 3
Scored = tuple[pd.DataFrame, dict[Run, Array], Array]
RUNS = (Run("gb", "paper"), Run("lr", "paper"))


@pytest.fixture(scope="module")
def scored(tmp_path_factory: pytest.TempPathFactory) -> Scored:
    """Of one marker; one row of test is 50 mm off, of one run another one too."""
    folder = tmp_path_factory.mktemp("left_out")
    samples = four_subsets(dict.fromkeys(SUBSETS, 40))
    write_table(to_table(samples), folder / "table.parquet")
    predicted = {}
    for run in RUNS:
        frames = []
        for subset, rows in samples.items():
            guess = rows.positions + 1.0
            if subset == "test":
                guess[GROSS] += 50.0
                guess[OTHER] += 30.0 * (run.model == "lr")
                predicted[run] = guess
            frames.append(pd.DataFrame(guess, columns=coordinate_columns(1)).assign(subset=subset))
        pd.concat(frames).to_parquet(folder / f"{run.model}.parquet")
    parts = []
    for subset in ("test", "extrapolation"):
        centre = samples[subset].positions.copy()
        centre[GROSS] += 50.0
        bounds = np.stack([centre - 2.0, centre + 2.0], axis=-1)
        parts.append(bounds_frame(bounds, subset, 0.9).assign(model="gb", preset="paper"))
        parts.append(bounds_frame(bounds, subset, 0.9).assign(model="lr", preset="paper"))
        parts.append(
            bounds_frame(np.broadcast_to([-np.inf, np.inf], bounds.shape), subset, 0.9).assign(
                model="gp", preset="paper"
            )
        )
    pd.concat(parts).to_parquet(folder / "scp.parquet")
    score_left_out(
        folder / "table.parquet",
        dataset="arm",
        predictions={run: folder / f"{run.model}.parquet" for run in RUNS},
        intervals={"scp": folder / "scp.parquet"},
        shown={Run("gb", "paper"), Run("gp", "paper")},
        confidence_levels=[0.9],
        output=folder / "left_out.csv",
    )
    frame = pd.read_csv(folder / "left_out.csv", keep_default_na=False)
    return frame, predicted, samples["test"].positions


def test_the_rows_that_move_a_number_are_listed_for_all_numbers(scored: Scored) -> None:
    frame, predicted, true = scored
    assert list(frame.columns) == COLUMNS
    on_test = frame[frame["subset"] == "test"]
    rows = on_test[on_test["left_out"].str.startswith("row ")]
    assert set(rows["left_out"]) == {f"row {GROSS}"}  # the largest of both runs
    of_rmse = rows[rows["metric"] == "rmse_mm"].set_index("model")
    rest = np.arange(len(true)) != GROSS
    for run in RUNS:
        assert of_rmse.loc[run.model, "value"] == pytest.approx(rmse_mm(true, predicted[run]))
        assert of_rmse.loc[run.model, "without"] == pytest.approx(rmse_mm(true[rest], predicted[run][rest]))
    assert of_rmse.loc["gb", "without"] == pytest.approx(1.0)


def test_intervals_of_the_shown_runs_are_scored_unless_they_are_infinite(scored: Scored) -> None:
    frame, _, true = scored
    of_intervals = frame[(frame["interval_method"] == "scp") & (frame["subset"] == "test")]
    assert set(of_intervals["model"]) == {"gb"}
    winkler = of_intervals[of_intervals["metric"] == "winkler_mm"].iloc[0]
    bounds = np.stack([true - 2.0, true + 2.0], axis=-1)
    assert winkler["without"] == pytest.approx(winkler_scores(true, bounds, 0.9).mean())
    assert winkler["value"] > 5 * winkler["without"]


def test_each_coordinate_is_left_out_of_r2(scored: Scored) -> None:
    frame, _, _ = scored
    assert set(frame.loc[frame["metric"] == "r2", "left_out"]) == {"m1_x", "m1_y", "m1_z"}
