from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.metrics.interval import worst_slab
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, TEST, Samples
from softkin.data.table import to_table, write_table
from softkin.evaluation.conditional_coverage import conditional_coverage
from tests.conftest import bending_arm


@pytest.fixture
def coverages(tmp_path: Path) -> pd.DataFrame:
    """Misses wherever the first command is above 0.5; `wide` has widths of many sizes, `narrow` one."""
    subsets = {subset: bending_arm(400, n_markers=2, seed=place) for place, subset in enumerate(SUBSETS)}
    write_table(to_table(subsets), tmp_path / "t.parquet")
    test = subsets[TEST]
    missed = test.commands[:, 0] > 0.5
    centre = test.positions + np.where(missed, 5.0, 0.0)[:, None]
    half = np.random.default_rng(0).uniform(1.0, 2.0, centre.shape)
    for name, width in (("narrow", np.ones(centre.shape)), ("wide", half)):
        frame = bounds_frame(np.stack([centre - width, centre + width], axis=-1), TEST, 0.9)
        frame.insert(0, "model", "gb")
        frame.insert(1, "preset", "paper")
        others = frame.assign(model="lr")
        pd.concat([frame, others]).to_parquet(tmp_path / f"{name}.parquet")
    conditional_coverage(
        tmp_path / "t.parquet",
        dataset="arm",
        intervals={name: tmp_path / f"{name}.parquet" for name in ("narrow", "wide")},
        shown={Run("gb", "paper")},
        confidence_levels=[0.9],
        seed=0,
        output=tmp_path / "c.csv",
    )
    return pd.read_csv(tmp_path / "c.csv")


def test_the_worst_slab_is_searched_and_measured_on_other_rows(coverages: pd.DataFrame) -> None:
    slab = coverages[(coverages["by"] == "slab") & (coverages["interval_method"] == "narrow")]
    assert slab["coverage"].item() < 0.1
    overall = coverages[(coverages["by"] == "marker") & (coverages["interval_method"] == "narrow")]["coverage"].item()
    assert overall == pytest.approx(0.75, abs=0.06)


def test_groups_share_the_rows_out(coverages: pd.DataFrame) -> None:
    narrow = coverages[coverages["interval_method"] == "narrow"].groupby("by")
    assert narrow["n_rows"].sum()[["command_norm", "predicted_position"]].tolist() == [400, 400]
    assert set(coverages["model"]) == {"gb"}
    by_norm = coverages[(coverages["by"] == "command_norm") & (coverages["interval_method"] == "narrow")]
    assert by_norm["coverage"].mean() == pytest.approx(0.75, abs=0.06)
    assert (by_norm["high"].to_numpy()[:-1] <= by_norm["low"].to_numpy()[1:]).all()
    assert (by_norm["standard_error"] >= 0).all()
    assert coverages[coverages["by"] == "marker"]["group"].unique().tolist() == ["m2"]  # the base never moves


def test_by_width_only_where_widths_differ(coverages: pd.DataFrame) -> None:
    assert set(coverages[coverages["by"].isin(["width", "hsic"])]["interval_method"]) == {"wide"}
    width = coverages[coverages["by"] == "width"]
    assert len(width) == 5
    assert width["coverage"].mean() == pytest.approx(0.75, abs=0.06)
    hsic = coverages.loc[coverages["by"] == "hsic", "value"].item()
    assert 0 <= hsic < 0.05  # misses have nothing to do with the width


def test_a_slab_of_even_coverage_is_not_made_to_look_bad() -> None:
    rng = np.random.default_rng(1)
    shares = []
    for seed in range(60):
        rows = Samples(rng.standard_normal((300, 3)), np.zeros((300, 3)))
        covered = (rng.uniform(size=300) < 0.9).astype(float)
        shares.append(covered[worst_slab(rows.commands, covered, seed)].mean())
    assert np.mean(shares) == pytest.approx(0.9, abs=4 * np.std(shares) / np.sqrt(60))
