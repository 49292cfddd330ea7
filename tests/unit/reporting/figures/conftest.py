"""Made-up results of one dataset with two commands, of one marker and of several, by a small pool."""

from __future__ import annotations

import itertools
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.metrics.interval import coverage_band, covered
from softkin.core.metrics.point import euclidean_errors
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, TRAIN, coordinate_columns
from softkin.data.table import read_subset, to_table, write_table
from softkin.evaluation.conditional_coverage import conditional_coverage
from softkin.models import MODELS
from softkin.reporting.figures.spec import DatasetResults
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.conftest import four_subsets

METHODS = ("qr", "cqr", "scp_mapie", "scp_crepes", "scp_spread")
RUNS = (Run("gb", "paper"), Run("gb", "tuned"), Run("gp", "paper"), Run("gp", "tuned"))
#: Predicted minus true position of a run in each coordinate, mm; three times as much on `extrapolation`.
OFF_MM = {RUNS[0]: 3.0, RUNS[1]: 2.0, RUNS[2]: 4.0, RUNS[3]: 1.0}
#: Rows of `test`, the first ones, whose intervals miss in each coordinate.
N_MISSED = 10


@pytest.fixture
def results(made_up: Path, tmp_path: Path) -> DatasetResults:
    """Of one marker: intervals of about two mm around the true position; those of the first rows miss it."""
    return results_in(shutil.copytree(made_up / "1", tmp_path / "one"))


@pytest.fixture
def results_of_many_markers(made_up: Path, tmp_path: Path) -> DatasetResults:
    """The same of three markers, of which the first is constant."""
    return results_in(shutil.copytree(made_up / "3", tmp_path / "many"))


@pytest.fixture(scope="session")
def made_up(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of results for robots of one and of three markers."""
    folder = tmp_path_factory.mktemp("figures")
    for n_markers in (1, 3):
        of_robot = folder / str(n_markers)
        of_robot.mkdir()
        subsets = four_subsets(dict.fromkeys(SUBSETS, 40), n_markers=n_markers)
        write_table(to_table(subsets), of_robot / "table.parquet")
        write_results(of_robot)
    return folder


def write_results(folder: Path) -> None:
    """Write the results that figures read beside the table of `folder`."""
    table = folder / "table.parquet"
    _predict(table, folder)
    _calibrate(table, folder)
    trials(folder / "gb.csv", 20)
    trials(folder / "gp.csv", 6)
    extrapolation_scores(folder / "extrapolation.csv")
    space_scores(folder / "spaces.csv")
    rows = [("gp", "tuned", "scp_spread", 1.0), ("gp", "tuned", "scp_mapie", 2.0), ("gb", "tuned", "cqr", 3.0)]
    choice = pd.DataFrame(rows, columns=["model", "preset", "interval_method", "cv_winkler_mm"])
    choice.assign(confidence_level=0.9, chosen=[True, False, False]).to_csv(folder / "choice.csv", index=False)
    conditional_coverage(
        table,
        dataset="arm",
        intervals={method: folder / f"{method}.parquet" for method in METHODS},
        shown={RUNS[0], RUNS[1], RUNS[3]},
        confidence_levels=[0.9],
        seed=0,
        output=folder / "conditional.csv",
    )


def results_in(folder: Path) -> DatasetResults:
    """The results that `write_results` wrote into a folder."""
    return DatasetResults(
        dataset="arm",
        title="ARM",
        table=folder / "table.parquet",
        predictions={run: folder / f"predictions_{run.model}_{run.preset}.parquet" for run in RUNS},
        trials={model: folder / f"{model}.csv" for model in ("gb", "gp")},
        intervals={method: folder / f"{method}.parquet" for method in METHODS},
        point=folder / "point.csv",
        interval_metrics=folder / "interval_metrics.csv",
        choice=folder / "choice.csv",
        conditional=folder / "conditional.csv",
        extrapolation=folder / "extrapolation.csv",
        target_spaces=folder / "spaces.csv",
        notes={"test": "made up"},
        model_titles={name: spec.title for name, spec in MODELS.items()},
        method_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        has_own_regressors={name: not of.calibrated_on.is_around_a_model for name, of in INTERVAL_METHODS.items()},
    )


def _predict(table: Path, folder: Path) -> None:
    """Write the predictions of every run, and their mean marker errors."""
    points = []
    columns = coordinate_columns(read_subset(table, TRAIN).positions.shape[1] // 3)
    for run in RUNS:
        frames = []
        for subset in SUBSETS:
            true = read_subset(table, subset).positions
            guess = true + (3.0 if subset == "extrapolation" else 1.0) * OFF_MM[run]
            frames.append(pd.DataFrame(guess, columns=columns).assign(subset=subset))
            key = {"subset": subset, "model": run.model, "preset": run.preset}
            points.append(key | {"euclidean_mean_mm": euclidean_errors(true, guess).mean()})
        pd.concat(frames).to_parquet(folder / f"predictions_{run.model}_{run.preset}.parquet")
    pd.DataFrame(points).to_csv(folder / "point.csv", index=False)


def _calibrate(table: Path, folder: Path) -> None:
    """Write the intervals of every method, and their scores."""
    rng = np.random.default_rng(0)
    scores: list[dict[str, Any]] = []
    for method in METHODS:
        frames = []
        for run in (RUNS[0], RUNS[1], RUNS[3]):
            for subset in ("test", "extrapolation"):
                true = read_subset(table, subset).positions
                centre = true.copy()
                centre[:N_MISSED] += 9.0
                half = rng.uniform(1.0, 3.0, centre.shape)
                bounds = np.stack([centre - half, centre + half], axis=-1)
                frames.append(bounds_frame(bounds, subset, 0.9).assign(model=run.model, preset=run.preset))
                key = {"subset": subset, "model": run.model, "preset": run.preset, "interval_method": method}
                scores += [key | row for row in interval_scores(covered(true, bounds), exact=method != "qr")]
        pd.concat(frames).to_parquet(folder / f"{method}.parquet")
    pd.DataFrame(scores).to_csv(folder / "interval_metrics.csv", index=False)


def interval_scores(is_covered: Any, *, exact: bool) -> list[dict[str, Any]]:
    """The rows of interval_metrics.csv that figures read, at two levels."""
    rows = []
    names = coordinate_columns(is_covered.shape[1] // 3)
    for level in (0.8, 0.9):
        low, high = coverage_band(len(is_covered), 40, int(np.ceil(level * 41)))
        common = {"confidence_level": level, "guarantee": "marginal" if exact else "no guarantee"}
        band = {"coverage_low": low, "coverage_high": high, "coverage_p_value": 0.5 if exact else np.nan}
        for name, column in zip(names, is_covered.T, strict=True):
            rows.append(common | band | {"coordinate": name, "coverage": column.mean()})
        rows += [common | {"coordinate": name, "coverage": is_covered.mean()} for name in ("mean", "mean_informative")]
        rows.append(common | {"coordinate": "joint", "coverage": is_covered.all(axis=1).mean()})
    return rows


def extrapolation_scores(path: Path) -> None:
    """Of two runs: one method covers as asked, one refuses on extrapolation, one is infinite there."""
    rows = []
    for run, subset in itertools.product((RUNS[0], RUNS[3]), ("test", "extrapolation")):
        out = subset == "extrapolation"
        key = {"model": run.model, "preset": run.preset, "subset": subset, "guarantee": "no guarantee"}
        for name, labels, coverage, ratio, refused in (
            ("scp_mapie", "none", 0.3 if out else 0.9, 4.0 if out else 1.1, ""),
            ("oracle", "all", 0.9, 1.0, ""),
            ("weighted", "none", np.nan if out else 0.9, np.nan if out else 1.0, "too few" if out else ""),
            ("adaptive", "all, each after its interval", 0.9, np.inf if out else 1.2, ""),
        ):
            scores = {"interval_method": name, "labels_used": labels, "coverage": coverage, "infinite_share": 0.0}
            scores |= {"winkler_ratio_to_oracle": ratio, "refused": refused}
            rows += [key | scores | {"confidence_level": level} for level in (0.8, 0.9)]
    pd.DataFrame(rows).to_csv(path, index=False)


def space_scores(path: Path) -> None:
    """Two models whose errors in curvature coordinates are half as large; the study of one of them chose these."""
    rows = [
        {"dataset": "arm", "subset": subset, "model": model, "target_space": space, "is_chosen": space == chosen}
        | {"shell_mae_mm": 1.0, "rmse_mm": error * (3.0 if subset == "extrapolation" else 1.0), "mae_mm": error / 2}
        for model, chosen in (("gb", "cartesian"), ("gp", "curvature"))
        for space, error in (("cartesian", 2.0), ("curvature", 1.0))
        for subset in ("test", "extrapolation")
    ]
    pd.DataFrame(rows).to_csv(path, index=False)


def trials(path: Path, n_complete: int) -> None:
    """A study where `rate` decides the error, `kind` nothing, and `depth` exists half the time; a third is pruned."""
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
