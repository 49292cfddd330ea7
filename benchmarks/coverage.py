"""Mean coverage of every method over random re-splits of validation and test, beside its theoretical value.

    python -m benchmarks.coverage [--results results] [--splits 200] [--seed 0] [--datasets finger ...]

Reads the stored outputs of a finished run. For each dataset, every method and region with an exact law, around the
paper's gradient boosting and the chosen model, and each level, the rows of `validation` and `test` are pooled and split
anew. The expected coverage of a coordinate, or of the whole robot, is then k / (n + 1), which lies in [level, level +
1/(n + 1)] (2/(n + 1) for two-sided ranks), if scores have no ties. Where they have (ELASTICA's copied rows, a forest)
it can only be higher. Prints the lowest and the highest coordinate and their distances from that band in standard
errors; more than 3 below is marked and makes the exit status 1, more than 3 above is marked.
"""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from benchmarks.finished_studies import record_of, studies_of
from softkin.core.metrics.interval import covered
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, TEST, TRAIN, VALIDATION, Array, informative_coordinates
from softkin.data.table import read_subset
from softkin.evaluation.score_regions import moving_residuals
from softkin.models.spec import PAPERS_RUN
from softkin.uncertainty.calibration_data import HeldOutCalibration, QuantileCalibration, SpreadCalibration
from softkin.uncertainty.choose import Resplittable, deployed_choice
from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.held_out_errors import difficulties
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.spec import MARGINAL
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.stored_outputs import StoredOutputs

LEVELS = [0.8, 0.9, 0.95]
Ranks = Callable[[int, float], int | None]


def outputs_of(folder: Path) -> StoredOutputs:
    """All stored outputs of a dataset but refits."""
    quantiles = {
        Run(path.parts[-3], path.parts[-2]): path for path in sorted(folder.glob("quantiles/*/*/quantiles.parquet"))
    }
    predictions = {Run(path.parts[-3], path.parts[-2]): path for path in sorted(folder.glob("*/*/predictions.parquet"))}
    deployed = deployed_choice(folder / "interval_choice.csv")
    runs = [] if deployed is None else [Run(deployed["model"], deployed["preset"])]
    return StoredOutputs(
        folder / "table.parquet",
        predictions=predictions,
        quantiles=quantiles,
        refits=None,
        confidence_levels=LEVELS,
        difficulties=difficulties(*studies_of(folder), {run: record_of(folder, run) for run in runs}),
    )


def pooled(data: Resplittable, truth: Array, n_test: int, moving: NDArray[np.bool_]) -> Resplittable:
    """The rows of `validation` and `test` as one calibration set, moving coordinates only."""
    if isinstance(data, QuantileCalibration):
        quantiles = np.concatenate([data.calibration, data.new[:, :n_test]], axis=1)
        return replace(data, calibration=quantiles[:, :, moving], truth=truth[:, moving])
    pool = replace(
        data,
        calibration=np.concatenate([data.calibration, data.new[:n_test]])[:, moving],
        truth=truth[:, moving],
        calibration_commands=np.concatenate([data.calibration_commands, data.new_commands[:n_test]]),
    )
    if isinstance(pool, SpreadCalibration):
        spread = np.concatenate([pool.calibration_spread, pool.new_spread[:n_test]])
        return replace(pool, train_spread=pool.train_spread[:, moving], calibration_spread=spread[:, moving])
    if isinstance(pool, HeldOutCalibration):
        return replace(pool, difficulty=replace(pool.difficulty, column=pool.difficulty.column[moving]))
    return pool


def coverages(folder: Path, splits: int, seed: int) -> Iterator[tuple[str, str, Ranks, int, Array]]:
    """Method, run, its rank, number of calibration rows, coverage (n_splits, n_levels, n_coordinates)."""
    outputs = outputs_of(folder)
    truth = {subset: read_subset(folder / "table.parquet", subset).positions for subset in SUBSETS}
    moving = informative_coordinates(truth[TRAIN])
    both = np.concatenate([truth[VALIDATION], truth[TEST]])
    n, n_test = len(truth[VALIDATION]), len(truth[TEST])
    choice = pd.read_csv(folder / "interval_choice.csv")
    runs = {PAPERS_RUN, *map(Run, choice["model"], choice["preset"])}
    orders = [np.random.default_rng([seed, split]).permutation(len(both)) for split in range(splits)]
    for name, method in INTERVAL_METHODS.items():
        if method.guarantee != MARGINAL or method.rank is None:
            continue
        for run, data in outputs.of(method.calibrated_on):
            if run not in runs:
                continue
            pool = pooled(data, both, n_test, moving)
            shares = []
            for order in orders:
                bounds = method.intervals(pool.resplit(order[:n], order[n:]), LEVELS)
                shares.append([covered(both[order[n:]][:, moving], level).mean(axis=0) for level in bounds])
            yield name, " ".join(run), method.rank, n, np.array(shares)
    markers = np.flatnonzero(moving) // 3
    for run, residuals in moving_residuals(outputs, truth):
        rows = np.concatenate([residuals[VALIDATION], residuals[TEST]])
        for name, region in REGION_METHODS.items():
            if run in runs and region.is_exact:
                shares = [
                    [
                        [region.region(residuals[TRAIN], rows[o[:n]], markers, level).covers(rows[o[n:]]).mean()]
                        for level in LEVELS
                    ]
                    for o in orders
                ]
                yield name, " ".join(run), conformal_rank, n, np.array(shares)


def main() -> int:
    """Print a line per dataset, method, run and level; return the exit status."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--splits", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--datasets", nargs="*")
    options = parser.parse_args()
    logging.disable(logging.INFO)  # MAPIE remarks on every corrected pair that crosses
    bad = 0
    head = f"{'dataset':<18}{'method':<20}{'around':<12}{'level':>6}{'expected':>10}"
    print(f"{head}{'lowest':>9}{'errors':>8}{'highest':>9}{'errors':>8}")
    for folder in sorted(path.parent for path in options.results.glob("*/table.parquet")):
        if options.datasets and folder.name not in options.datasets:
            continue
        for name, run, rank_of, n, shares in coverages(folder, options.splits, options.seed):
            means = shares.mean(axis=0)
            errors = np.maximum(shares.std(axis=0, ddof=1) / np.sqrt(options.splits), 1e-12)
            for place, level in enumerate(LEVELS):
                rank = rank_of(n, level)
                if rank is None:
                    continue
                expected = rank / (n + 1)
                low, high = int(np.argmin(means[place])), int(np.argmax(means[place]))
                below = (means[place, low] - level) / errors[place, low]
                above = (means[place, high] - expected) / errors[place, high]
                mark = "  BELOW" if below < -3 else "  above" if above > 3 else ""
                bad += below < -3
                numbers = f"{means[place, low]:>9.4f}{below:>8.1f}{means[place, high]:>9.4f}{above:>8.1f}"
                print(f"{folder.name:<18}{name:<20}{run:<12}{level:>6}{expected:>10.4f}{numbers}{mark}", flush=True)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
