"""The robot in time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.core.samples import SUBSETS
from softkin.data.table import read_subset, to_table, write_table
from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.time import frame, plot
from tests.recorded_robot import recorded_arm
from tests.unit.reporting.figures.conftest import results_in, write_results


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> DatasetResults:
    folder: Path = tmp_path_factory.mktemp("recorded")
    rows = recorded_arm(600, backlash=0.05, zeros_mm=(0.0, 4.0))
    order = np.random.default_rng(0).permutation(600)
    parts = {subset: rows.take(part) for subset, part in zip(SUBSETS, np.array_split(order, 4), strict=True)}
    write_table(to_table(parts), folder / "table.parquet")
    write_results(folder)
    return results_in(folder)


def test_a_pose_has_its_time_its_zero_and_its_direction(recorded: DatasetResults) -> None:
    rows = frame(recorded)
    assert rows["coordinate"].unique().tolist() == ["m1_x", "m1_y"]
    of_x = rows[rows["coordinate"] == "m1_x"]
    assert of_x["order"].is_monotonic_increasing
    zeros = of_x.groupby("session")["zero_mm"].first()
    assert zeros[2] - zeros[1] == pytest.approx(4.0, abs=0.8)
    assert set(of_x["command_name"]) == {"u1"}
    in_order = read_subset(recorded.table, "test")
    assert in_order.recording is not None
    step = in_order.commands[:, 0] - in_order.recording.memory[:, 0]
    found = of_x.set_index("order")["comes_from"]
    assert (found[in_order.recording.order].to_numpy() == np.where(step > 0, "below", "above")).all()


def test_only_rows_that_were_not_fitted_show_what_the_model_leaves(recorded: DatasetResults) -> None:
    rows = frame(recorded)
    assert rows.loc[rows["subset"] == "train", "deployed_mm"].isna().all()
    of_test = rows.loc[rows["subset"] == "test", "deployed_mm"]
    np.testing.assert_allclose(of_test, -1.0)  # the run predicts 1 mm too much


def test_the_gap_between_the_branches_is_written(recorded: DatasetResults) -> None:
    figure = plot(frame(recorded), recorded)
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert sum("zero" in text for text in texts) == 4
    static, closed = (float(text.split()[1]) for text in texts if text.startswith("gap"))
    assert static > 3
    assert closed == 0


def test_without_a_recording_there_is_no_figure(results: DatasetResults) -> None:
    assert frame(results).empty
