"""Scores in time: sessions never seen, and later rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.metrics.point import mae_mm, rmse_mm
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import to_table, write_table
from softkin.evaluation.recorded_names import COLUMNS
from softkin.evaluation.score_recorded import Member, Part, RecordedRun, in_time, next_sessions, plain, score_recorded
from softkin.models import MODELS
from softkin.training.bounded_rows import some_rows
from softkin.training.kinematic_model import FitSettings
from tests.conftest import four_subsets
from tests.recorded_robot import recorded_arm

GP = {"kernel": "rbf", "trend": "linear", "max_iter": 20, "learning_rows": 150}
ROWS = recorded_arm(600, backlash=0.05, zeros_mm=(0.0, 3.0, -1.5))


def subsets(rows: Samples) -> dict[str, Samples]:
    """70 / 10 / 10 / 10 % at random."""
    order = np.random.default_rng(0).permutation(len(rows))
    cuts = np.cumsum([int(0.7 * len(rows)), int(0.1 * len(rows)), int(0.1 * len(rows))])
    return {subset: rows.take(np.sort(part)) for subset, part in zip(SUBSETS, np.split(order, cuts), strict=True)}


def scores(samples: dict[str, Samples], folder: Path) -> pd.DataFrame:
    write_table(to_table(samples), folder / "table.parquet")
    settings = FitSettings(GP, True, 0, 1, memory={"memory": "play", "widths": "all", "zeros": True})
    run = RecordedRun(Run("gp", "tuned"), [Member(MODELS["gp"], settings, 1.0)], 0, 0.9)
    score_recorded(folder / "table.parquet", dataset="arm", run=run, output=folder / "recorded.csv")
    return pd.read_csv(folder / "recorded.csv")


@pytest.fixture(scope="module")
def frame(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("softkin.evaluation.score_recorded.N_DRAWS", 40)
        return scores(subsets(ROWS), tmp_path_factory.mktemp("recorded"))


def test_every_split_has_its_rows(frame: pd.DataFrame) -> None:
    assert list(frame.columns) == COLUMNS
    assert set(frame["memory"]) == {"none", "play"}
    rows = frame[frame["memory"] == "play"].groupby(["split", "subset"], sort=False).size()
    assert rows.to_dict() == {
        ("published", "test"): 1,
        ("published", "extrapolation"): 1,
        **{("published_in_parts", f"test, session {session}"): 3 for session in (1, 2, 3)},
        **{("published_in_parts", f"test, block {block} of 4"): 3 for block in (1, 2, 3, 4)},
        ("later", "last 20%"): 3,
        **{("later_in_parts", f"last 20%, block {block} of 4"): 3 for block in (1, 2, 3, 4)},
        ("next_session", "2 after 1"): 7,
        ("next_session", "3 after 1"): 7,
        ("next_session", "3 after 1+2"): 7,
        **{
            ("next_session_in_parts", f"{name}, block {block} of 4"): 3
            for name in ("2 after 1", "3 after 1", "3 after 1+2")
            for block in (1, 2, 3, 4)
        },
    }


def test_parts_of_time_make_up_the_whole(frame: pd.DataFrame) -> None:
    """Blocks are of the same length: the mean of their coverages is that of all rows, whatever the method."""
    key = ["memory", "method"]
    whole = frame[(frame["split"] == "next_session") & (frame["subset"] == "2 after 1")].set_index(key)["coverage"]
    parts = frame[frame["subset"].str.startswith("2 after 1, block")].groupby(key)["coverage"].mean()
    assert len(parts) == 6
    whole = whole[~whole.index.get_level_values("method").str.startswith("recalibrated")]
    np.testing.assert_allclose(parts, whole.reindex(parts.index), atol=0.01)


def test_a_few_poses_give_a_new_session_its_coverage_back(frame: pd.DataFrame) -> None:
    played = frame[(frame["memory"] == "play") & (frame["subset"] == "2 after 1")].set_index("method")
    plain, again = played.loc["split conformal"], played.loc["recalibrated"].set_index("n_recalibration_poses")
    assert plain["coverage"] < 0.75
    assert (again["coverage"] > [0.87, 0.89, 0.89]).all()
    assert (again["mean_width_mm"] < 1.25 * plain["mean_width_mm"]).all()
    assert played.loc["adaptive", "coverage"] > plain["coverage"]
    assert played.loc["recalibrated on the first poses", "rmse_mm"] < plain["rmse_mm"] / 4


def test_without_a_recording_there_is_nothing_to_score(tmp_path: Path) -> None:
    empty = scores(four_subsets(dict.fromkeys(SUBSETS, 30)), tmp_path)
    assert empty.empty
    assert list(empty.columns) == COLUMNS


def test_errors_are_scored_as_the_point_metrics_score_positions() -> None:
    true, predicted = np.random.default_rng(4).normal(size=(2, 37, 3))
    of_errors = plain(Part(np.ones((19, 3)), true - predicted, None), 0.9)
    assert (of_errors["rmse_mm"], of_errors["mae_mm"]) == (rmse_mm(true, predicted), mae_mm(true, predicted))


def test_the_sessions_that_are_fitted_on() -> None:
    assert next_sessions([1]) == []
    assert next_sessions([1, 2]) == [([1], 2)]
    assert next_sessions([1, 2, 3]) == [([1], 2), ([1], 3), ([1, 2], 3)]


def test_rows_of_all_subsets_come_in_the_order_of_time() -> None:
    parts = subsets(ROWS)
    together = in_time(list(parts.values()))
    np.testing.assert_array_equal(together.inputs, ROWS.inputs)
    np.testing.assert_array_equal(together.positions, ROWS.positions)


def test_a_member_is_fitted_on_as_many_rows_as_it_takes() -> None:
    settings = FitSettings({}, True, 0, 1, memory={"memory": "none", "zeros": True})
    bounded, whole = (
        RecordedRun(Run("lr", "tuned"), [Member(MODELS["lr"], settings, 1.0, most)], 0, 0.9) for most in (60, None)
    )
    expected = whole.fitted(some_rows(ROWS, 60, 0)).predict(ROWS.inputs)
    np.testing.assert_array_equal(bounded.fitted(ROWS).predict(ROWS.inputs), expected)
    assert np.abs(whole.fitted(ROWS).predict(ROWS.inputs) - expected).max() > 0
