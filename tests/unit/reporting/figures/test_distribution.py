"""The paper's Figure 3."""

from __future__ import annotations

import numpy as np

from softkin.core.samples import SUBSETS
from softkin.data.table import read_subset
from softkin.reporting.figures.distribution import frame
from softkin.reporting.figures.spec import DatasetResults


def test_it_is_the_share_of_rows_up_to_each_position(results: DatasetResults) -> None:
    rows = frame(results)
    assert set(rows["subset"]) == set(SUBSETS)
    assert set(rows["coordinate"]) == {"m1_x", "m1_y", "m1_z"}
    true = read_subset(results.table, "extrapolation").positions[:, 2]
    mine = rows[(rows["subset"] == "extrapolation") & (rows["coordinate"] == "m1_z")]
    for row in mine.itertuples():
        assert row.share == np.mean(true <= row.position_mm)
