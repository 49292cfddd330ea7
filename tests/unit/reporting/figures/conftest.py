"""Made-up results of one dataset with two commands and one marker, of a small pool."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.metrics.interval import coverage_band, covered
from softkin.core.metrics.point import euclidean_errors
from softkin.core.samples import SUBSETS, coordinate_columns
from softkin.data.table import read_subset
from softkin.evaluation.conditional_coverage import conditional_coverage
from softkin.models import MODELS
from softkin.reporting.figures.spec import DatasetResults
from softkin.uncertainty.intervals import INTERVAL_METHODS

METHODS = ("qr", "cqr", "scp_mapie", "scp_crepes", "scp_spread")
RUNS = (("gb", "paper"), ("gb", "tuned"), ("gp", "paper"), ("gp", "tuned"))
#: How far off a model is in each coordinate, mm.
OFF_MM = {("gb", "paper"): 3.0, ("gb", "tuned"): 2.0, ("gp", "paper"): 4.0, ("gp", "tuned"): 1.0}
COORDINATES = coordinate_columns(1)


@pytest.fixture
def results(table: Path, tmp_path: Path) -> DatasetResults:
    """Intervals of two mm or so around the truth, but for the first ten rows, which are missed."""
    rng = np.random.default_rng(0)
    predictions, points = {}, []
    for run in RUNS:
        frames = []
        for subset in SUBSETS:
            true = read_subset(table, subset).positions
            outside = 3.0 if subset == "extrapolation" else 1.0
            guess = true + outside * OFF_MM[run]
            frames.append(pd.DataFrame(guess, columns=COORDINATES).assign(subset=subset))
            key = {"subset": subset, "model": run[0], "preset": run[1]}
            points.append(key | {"euclidean_mean_mm": euclidean_errors(true, guess).mean()})
        predictions[run] = tmp_path / f"predictions_{run[0]}_{run[1]}.parquet"
        pd.concat(frames).to_parquet(predictions[run])
    pd.DataFrame(points).to_csv(tmp_path / "point.csv", index=False)

    metrics: list[dict[str, Any]] = []
    for method in METHODS:
        frames = []
        for model, preset in (("gb", "paper"), ("gb", "tuned"), ("gp", "tuned")):
            for subset in ("test", "extrapolation"):
                true = read_subset(table, subset).positions
                centre = true.copy()
                centre[:10] += 9.0
                half = rng.uniform(1.0, 3.0, centre.shape)
                bounds = np.stack([centre - half, centre + half], axis=-1)
                frames.append(bounds_frame(bounds, subset, 0.9).assign(model=model, preset=preset))
                key = {"subset": subset, "model": model, "preset": preset, "interval_method": method}
                metrics += [key | row for row in interval_scores(covered(true, bounds), exact=method != "qr")]
        pd.concat(frames).to_parquet(tmp_path / f"{method}.parquet")
    pd.DataFrame(metrics).to_csv(tmp_path / "interval_metrics.csv", index=False)

    rows = [("gp", "tuned", "scp_spread", 1.0), ("gp", "tuned", "scp_mapie", 2.0), ("gb", "tuned", "cqr", 3.0)]
    choice = pd.DataFrame(rows, columns=["model", "preset", "interval_method", "cv_winkler_mm"])
    choice.assign(confidence_level=0.9, chosen=[True, False, False]).to_csv(tmp_path / "choice.csv", index=False)
    intervals = {method: tmp_path / f"{method}.parquet" for method in METHODS}
    conditional_coverage(
        table,
        dataset="arm",
        intervals=intervals,
        shown={("gp", "tuned"), ("gb", "paper"), ("gb", "tuned")},
        confidence_levels=[0.9],
        seed=0,
        output=tmp_path / "conditional.csv",
    )
    return DatasetResults(
        dataset="arm",
        title="ARM",
        table=table,
        predictions=predictions,
        trials={"gb": trials(tmp_path / "gb.csv", 20), "gp": trials(tmp_path / "gp.csv", 6)},
        intervals=intervals,
        point=tmp_path / "point.csv",
        interval_metrics=tmp_path / "interval_metrics.csv",
        choice=tmp_path / "choice.csv",
        conditional=tmp_path / "conditional.csv",
        outside=outside_scores(tmp_path / "outside.csv"),
        spaces=space_scores(tmp_path / "spaces.csv"),
        notes={"test": "made up"},
        model_titles={name: spec.title for name, spec in MODELS.items()},
        method_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        on_quantiles={name: method.on == "quantiles" for name, method in INTERVAL_METHODS.items()},
    )


def interval_scores(inside: Any, *, exact: bool) -> list[dict[str, Any]]:
    """The rows of interval_metrics.csv that figures read, at two levels."""
    rows = []
    for level in (0.8, 0.9):
        low, high = coverage_band(len(inside), 40, int(np.ceil(level * 41)))
        common = {"confidence_level": level, "guarantee": "marginal" if exact else "no guarantee"}
        band = {"coverage_low": low, "coverage_high": high, "coverage_p_value": 0.5 if exact else np.nan}
        for name, column in zip(COORDINATES, inside.T, strict=True):
            rows.append(common | band | {"coordinate": name, "coverage": column.mean()})
        rows += [common | {"coordinate": name, "coverage": inside.mean()} for name in ("mean", "mean_informative")]
        rows.append(common | {"coordinate": "joint", "coverage": inside.all(axis=1).mean()})
    return rows


def outside_scores(path: Path) -> Path:
    """Of two runs: one method covers what it says, one refuses on extrapolation, one is infinite there."""
    rows = []
    for (model, preset), subset in itertools.product((("gb", "paper"), ("gp", "tuned")), ("test", "extrapolation")):
        out = subset == "extrapolation"
        key = {"model": model, "preset": preset, "subset": subset, "guarantee": "no guarantee"}
        for name, labels, coverage, ratio, refused in (
            ("scp_mapie", "none", 0.3 if out else 0.9, 4.0 if out else 1.1, ""),
            ("oracle", "all", 0.9, 1.0, ""),
            ("weighted", "none", np.nan if out else 0.9, np.nan if out else 1.0, "too few" if out else ""),
            ("adaptive", "all, each after its interval", 0.9, np.inf if out else 1.2, ""),
        ):
            about = {"interval_method": name, "labels_used": labels, "coverage": coverage, "infinite_share": 0.0}
            about |= {"winkler_ratio_to_oracle": ratio, "refused": refused}
            rows += [key | about | {"confidence_level": level} for level in (0.8, 0.9)]
    pd.DataFrame(rows).to_csv(path, index=False)
    return path


def space_scores(path: Path) -> Path:
    """Two models, twice as good in curvature coordinates, which one of them was given."""
    rows = [
        {"dataset": "arm", "subset": subset, "model": model, "target_space": space, "is_chosen": space == chosen}
        | {"shell_mae_mm": 1.0, "rmse_mm": error * (3.0 if subset == "extrapolation" else 1.0), "mae_mm": error / 2}
        for model, chosen in (("gb", "cartesian"), ("gp", "curvature"))
        for space, error, is_chosen in (
            ("cartesian", 2.0, chosen == "cartesian"),
            ("curvature", 1.0, chosen != "cartesian"),
        )
        for subset in ("test", "extrapolation")
    ]
    pd.DataFrame(rows).to_csv(path, index=False)
    return path


def trials(path: Path, n_complete: int) -> Path:
    """A study in which the rate decides all, the kind nothing, the depth is there half the time; every third pruned."""
    rng = np.random.default_rng(1)
    n = n_complete * 3 // 2
    complete = np.arange(n) % 3 != 2
    rate = rng.uniform(0.1, 1.0, n)
    frame = pd.DataFrame({"trial": np.arange(n), "state": np.where(complete, "COMPLETE", "PRUNED")})
    frame["score_mm"] = np.where(complete, 1.0 + 5.0 * rate, np.nan)
    frame["first_part_mm"] = 1.0 + 4.0 * rate
    frame["param_kind"] = rng.choice(["a", "b"], n)
    frame["param_depth"] = np.where(rng.random(n) < 0.5, np.nan, 3.0)
    frame["param_rate"] = rate
    frame.assign(param_same=1.0).to_csv(path, index=False)
    return path
