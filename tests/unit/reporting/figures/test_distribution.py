"""The paper's Figure 3."""

from __future__ import annotations

import numpy as np

from softkin.core.samples import SUBSETS
from softkin.data.table import read_subset
from softkin.reporting.figures.distribution import frame, plot
from softkin.reporting.figures.spec import DatasetResults


def test_it_is_the_share_of_rows_up_to_each_position(results: DatasetResults) -> None:
    rows = frame(results)
    assert set(rows["subset"]) == set(SUBSETS)
    assert set(rows["coordinate"]) == {"m1_x", "m1_y", "m1_z"}
    true = read_subset(results.table, "extrapolation").positions[:, 2]
    of_coordinate = rows[(rows["subset"] == "extrapolation") & (rows["coordinate"] == "m1_z")]
    for row in of_coordinate.itertuples():
        assert row.share == np.mean(true <= row.position_mm)


def test_of_several_markers_the_one_that_moves_furthest_is_shown(results_of_many_markers: DatasetResults) -> None:
    rows = frame(results_of_many_markers)
    assert set(rows["coordinate"]) == {"m3_x", "m3_y", "m3_z"}
    drawn = plot(rows, results_of_many_markers)
    assert [axes.get_xlabel() for axes in drawn.axes] == ["m3_x (mm)", "m3_y (mm)", "m3_z (mm)"]
    assert "marker m3" in drawn.get_suptitle()
