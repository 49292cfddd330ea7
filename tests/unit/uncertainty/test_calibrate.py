from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray

from softkin.core.bounds import bounds_frame, read_bounds
from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import read_subset, to_table, write_table
from softkin.uncertainty.calibrate import calibrate
from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.stored_outputs import StoredOutputs

LEVELS = [0.8, 0.9]
RUN = ("mlp", "paper")


def evidences_of(table: Path, folder: Path) -> StoredOutputs:
    return StoredOutputs(
        table,
        predictions={RUN: folder / "predictions.parquet"},
        quantiles={RUN: folder / "quantiles.parquet"},
        refits=folder / "refits.npz",
        confidence_levels=LEVELS,
        shells=folder / "shells.npz",
    )


@pytest.fixture
def stored(table: Path, tmp_path: Path) -> Path:
    """Folder of predictions one mm off in x, all of them sure to 2 mm; quantiles two mm around the truth."""
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    predictions["m1_x"] += 1.0
    for coordinate in ("m1_x", "m1_y", "m1_z"):
        predictions[f"std_{coordinate}"] = 2.0
    predictions.to_parquet(tmp_path / "predictions.parquet")
    frames = []
    for subset in ("validation", "test", "extrapolation"):
        true = read_subset(table, subset).positions
        frames += [bounds_frame(np.stack([true - 2, true + 2], axis=-1), subset, level) for level in LEVELS]
    pd.concat(frames).to_parquet(tmp_path / "quantiles.parquet")
    truth = [read_subset(table, subset).positions for subset in ("train", "test", "extrapolation")]
    rng = np.random.default_rng(0)
    fold = np.arange(len(truth[0])) % 4
    np.savez(
        tmp_path / "refits.npz",
        **{
            "fold_of_row": fold,
            "resample_rows": rng.integers(len(fold), size=(30, len(fold))),
            "mlp/paper/folds": np.concatenate(truth)[None] + rng.standard_normal((4, 1, 3)),
            "mlp/paper/resamples": np.concatenate(truth)[None] + rng.standard_normal((30, 1, 3)),
        },
    )
    train = read_subset(table, "train")
    norms = np.linalg.norm(train.commands, axis=1)
    shells: dict[str, NDArray[Any]] = {"centre": np.zeros(2), "scale": np.ones(2)}
    for place, radius in enumerate(np.quantile(norms, [0.4, 0.5])):
        shell = np.flatnonzero(norms > radius)
        shells |= {f"core_{place}": np.flatnonzero(norms <= radius), f"shell_{place}": shell}
        shells[f"mlp/paper/{place}"] = train.positions[shell] + rng.uniform(1, 2, (len(shell), 3))
    np.savez(tmp_path / "shells.npz", **shells)
    return tmp_path


def run(table: Path, folder: Path, method: str, output: Path) -> pd.DataFrame:
    methods = {method: INTERVAL_METHODS[method]}
    calibrate(evidences_of(table, folder), methods=methods, inside={}, intervals={method: output})
    return pd.read_parquet(output)


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_every_method_fills_test_and_extrapolation(table: Path, stored: Path, method: str) -> None:
    frame = run(table, stored, method, stored / "out.parquet")
    assert list(frame.columns[:5]) == ["model", "preset", "subset", "confidence_level", "lower_m1_x"]
    for subset in ("test", "extrapolation"):
        bounds = read_bounds(frame, subset, LEVELS)
        true = read_subset(table, subset).positions
        assert bounds.shape == (2, len(true), 3, 2)
        assert ((bounds[..., 0] <= true + 1e-9) & (true <= bounds[..., 1] + 1e-9)).mean() > 0.75


def test_a_known_residual_sets_the_width(table: Path, stored: Path) -> None:
    frame = run(table, stored, "scp_mapie", stored / "out.parquet")
    width = frame["upper_m1_x"] - frame["lower_m1_x"]
    assert width.to_numpy() == pytest.approx(2.0)
    assert (frame["upper_m1_y"] - frame["lower_m1_y"]).to_numpy() == pytest.approx(0.0)


def test_the_deployed_run_has_its_own_method_inside(table: Path, stored: Path) -> None:
    """Here the interval of a model sure to 2 mm, far wider than split conformal prediction's."""
    wide = INTERVAL_METHODS["gaussian"]
    output = stored / "out.parquet"
    frames = []
    for inside in ({}, {RUN: wide}):
        calibrate(
            evidences_of(table, stored),
            methods={"auto": INTERVAL_METHODS["auto"]},
            inside=inside,
            intervals={"auto": output},
        )
        frames.append(pd.read_parquet(output))
    split, own, gaussian = *frames, run(table, stored, "gaussian", output)
    width = [(frame["upper_m1_y"] - frame["lower_m1_y"])[frame["subset"] == "test"] for frame in (split, own, gaussian)]
    inside = width[0] < 1e-9
    assert inside.sum() > 20
    np.testing.assert_allclose(width[1][inside], width[2][inside])
    assert (width[1] >= np.maximum(width[0], width[2]) - 1e-9).all()


def test_a_model_without_a_spread_is_left_out_where_one_is_needed(table: Path, stored: Path) -> None:
    predictions = pd.read_parquet(stored / "predictions.parquet")
    predictions[["subset", "m1_x", "m1_y", "m1_z"]].to_parquet(stored / "predictions.parquet")
    assert len(run(table, stored, "scp_spread", stored / "out.parquet")) == 0
    renamed = predictions.rename(columns=lambda name: name.replace("std_", "spread_"))
    renamed.to_parquet(stored / "predictions.parquet")
    assert len(run(table, stored, "scp_spread", stored / "out.parquet")) > 0
    assert len(run(table, stored, "gaussian", stored / "out.parquet")) == 0


@pytest.mark.parametrize("method", INTERVAL_METHODS)
def test_truth_is_looked_at_on_train_and_validation_only(table: Path, stored: Path, method: str) -> None:
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    spared = ("train", "validation")
    garbage = {s: Samples(r.commands, 1e6 - r.positions) for s, r in subsets.items() if s not in spared}
    write_table(to_table(subsets | garbage), stored / "garbage.parquet")
    honest = run(table, stored, method, stored / "a.parquet")
    pd.testing.assert_frame_equal(honest, run(stored / "garbage.parquet", stored, method, stored / "b.parquet"))


@pytest.mark.parametrize("method", ["scp_mapie", "scp_crepes", "scp_spread", "scp_distance", "cps"])
def test_coverage_over_random_splits_is_what_theory_says(method: str) -> None:
    """300 splits of 88 calibration and 89 test rows, as FINGER has: mean coverage is k / (n + 1), within 4 errors."""
    from tests.unit.intervals.test_engines import spread_evidence

    n, m, splits = 88, 89, 300
    spec = INTERVAL_METHODS[method]
    shares = []
    rng = np.random.default_rng(5)
    for split in range(splits):
        base = spread_evidence(n, 3, m, split)
        truth = base.new + rng.standard_t(3, base.new.shape) * np.arange(1, 4)
        bounds = spec.intervals(base, LEVELS)
        shares.append(((bounds[..., 0] <= truth) & (truth <= bounds[..., 1])).mean(axis=1))
    means, errors = np.mean(shares, axis=0), np.std(shares, axis=0) / np.sqrt(splits)
    for place, level in enumerate(LEVELS):
        assert spec.rank is not None
        rank = spec.rank(n, level)
        assert rank is not None
        assert level <= rank / (n + 1) <= level + 2 / (n + 1)
        np.testing.assert_array_less(np.abs(means[place] - rank / (n + 1)), 4 * errors[place])
    assert conformal_rank(n, 0.9) == 81
