from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.calibrating import calibrate
from softkin.conformal import conformal_rank
from softkin.datasets.table import read_subset, to_table, write_table
from softkin.interface import SUBSETS, Samples
from softkin.intervals import INTERVAL_METHODS
from softkin.quantiles import bounds_frame, read_bounds

LEVELS = [0.8, 0.9]


@pytest.fixture
def sources(table: Path, tmp_path: Path) -> dict[str, str]:
    """Predictions one mm off in x; quantiles two mm around the truth."""
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    predictions["m1_x"] += 1.0
    predictions.to_parquet(tmp_path / "predictions.parquet")
    frames = []
    for subset in ("validation", "test", "extrapolation"):
        true = read_subset(table, subset).positions
        frames += [bounds_frame(np.stack([true - 2, true + 2], axis=-1), subset, level) for level in LEVELS]
    pd.concat(frames).to_parquet(tmp_path / "quantiles.parquet")
    return {on: str(tmp_path / f"{on}.parquet") for on in ("predictions", "quantiles")}


def run(table: Path, method: str, source: str, output: Path) -> pd.DataFrame:
    calibrate(
        table,
        method=INTERVAL_METHODS[method],
        sources={("gb", "paper"): source},
        confidence_levels=LEVELS,
        intervals=output,
    )
    return pd.read_parquet(output)


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_every_method_fills_test_and_extrapolation(
    table: Path, sources: dict[str, str], tmp_path: Path, method: str
) -> None:
    stored = run(table, method, sources[INTERVAL_METHODS[method].on], tmp_path / "out.parquet")
    assert list(stored.columns[:5]) == ["model", "preset", "subset", "confidence_level", "lower_m1_x"]
    for subset in ("test", "extrapolation"):
        bounds = read_bounds(stored, subset, LEVELS)
        true = read_subset(table, subset).positions
        assert bounds.shape == (2, len(true), 3, 2)
        assert ((bounds[..., 0] <= true + 1e-9) & (true <= bounds[..., 1] + 1e-9)).all()


def test_a_known_residual_sets_the_width(table: Path, sources: dict[str, str], tmp_path: Path) -> None:
    stored = run(table, "scp_mapie", sources["predictions"], tmp_path / "out.parquet")
    width = stored["upper_m1_x"] - stored["lower_m1_x"]
    assert width.to_numpy() == pytest.approx(2.0)
    assert (stored["upper_m1_y"] - stored["lower_m1_y"]).to_numpy() == pytest.approx(0.0)


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_only_the_truth_of_validation_is_looked_at(
    table: Path, sources: dict[str, str], tmp_path: Path, method: str
) -> None:
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    garbage = {s: Samples(r.commands, 1e6 - r.positions) for s, r in subsets.items() if s != "validation"}
    write_table(to_table(subsets | garbage), tmp_path / "garbage.parquet")
    source = sources[INTERVAL_METHODS[method].on]
    honest = run(table, method, source, tmp_path / "a.parquet")
    pd.testing.assert_frame_equal(honest, run(tmp_path / "garbage.parquet", method, source, tmp_path / "b.parquet"))


@pytest.mark.parametrize("method", ["scp_mapie", "scp_crepes"])
def test_coverage_over_random_splits_is_what_theory_says(table: Path, tmp_path: Path, method: str) -> None:
    """300 splits of 88 calibration and 89 test rows, as FINGER has: mean coverage is k / (n + 1), within 4 errors."""
    rng = np.random.default_rng(5)
    n, m, splits = 88, 89, 300
    base = read_subset(table, "train")
    shares = []
    for _ in range(splits):
        truth = rng.standard_normal((n + m, 3)) * [1.0, 5.0, 20.0]
        noise = rng.standard_t(3, truth.shape)
        rows = {"train": base, "validation": _rows(truth[:n]), "test": _rows(truth[n:]), "extrapolation": base}
        write_table(to_table(rows), tmp_path / "t.parquet")
        predicted = rows | {"validation": _rows((truth + noise)[:n]), "test": _rows((truth + noise)[n:])}
        to_table(predicted).drop(columns=["u1", "u2"]).to_parquet(tmp_path / "p.parquet")
        stored = run(tmp_path / "t.parquet", method, str(tmp_path / "p.parquet"), tmp_path / "i.parquet")
        bounds = read_bounds(stored, "test", LEVELS)
        inside = (bounds[..., 0] <= truth[n:]) & (truth[n:] <= bounds[..., 1])
        shares.append(inside.mean(axis=1))
    means, errors = np.mean(shares, axis=0), np.std(shares, axis=0) / np.sqrt(splits)
    for place, level in enumerate(LEVELS):
        rank = conformal_rank(n, level)
        assert rank is not None
        assert level <= rank / (n + 1) <= level + 1 / (n + 1)
        np.testing.assert_array_less(np.abs(means[place] - rank / (n + 1)), 4 * errors[place])


def _rows(positions: np.ndarray) -> Samples:
    return Samples(np.zeros((len(positions), 2)), positions)
