"""Is 90 % true? Mean coverage over random re-splits of validation and test, against what theory says.

    python benchmarks/coverage.py [--results results] [--splits 200] [--seed 0]

Reads the stored predictions and quantiles of a finished run. For each dataset, calibrated method and level, the rows
of `validation` and `test` are pooled and split anew; the expected coverage of a coordinate is then exactly k / (n + 1),
which lies in [level, level + 1/(n + 1)], if scores have no ties. Where they have (ELASTICA's copied rows) coverage can
only be higher. Prints the worst coordinate of each and its distance from the level in standard errors; one more than 3
below is marked, and the exit status is then 1.
"""

from __future__ import annotations

import argparse
import logging
import sys
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.calibrating import STORED
from softkin.conformal import conformal_rank
from softkin.datasets.table import read_subset
from softkin.interface import TEST, TRAIN, VALIDATION, Array, Evidence, informative_coordinates
from softkin.intervals import INTERVAL_METHODS

LEVELS = (0.8, 0.9, 0.95)
FILES = {"predictions": "gb/paper/predictions.parquet", "quantiles": "quantiles/gb/paper/quantiles.parquet"}


def coverages(folder: Path, method: str, splits: int, seed: int) -> tuple[Array, int]:
    """Coverage (n_splits, n_levels, n_coordinates) over moving coordinates, and the number of calibration rows."""
    table = folder / "table.parquet"
    moving = informative_coordinates(read_subset(table, TRAIN).positions)
    on = INTERVAL_METHODS[method].on
    stored = pd.read_parquet(folder / FILES[on])
    axis = 0 if on == "predictions" else 1
    parts = [STORED[on](stored, subset, LEVELS) for subset in (VALIDATION, TEST)]
    pool = np.concatenate(parts, axis=axis).compress(moving, axis=axis + 1)
    truth = np.concatenate([read_subset(table, subset).positions for subset in (VALIDATION, TEST)])[:, moving]
    n = parts[0].shape[axis]
    rng = np.random.default_rng(seed)
    result = []
    for _ in range(splits):
        order = rng.permutation(len(truth))
        calibration, new = order[:n], order[n:]
        evidence = Evidence(pool.take(calibration, axis), truth[calibration], pool.take(new, axis))
        bounds = INTERVAL_METHODS[method].intervals(evidence, LEVELS)
        result.append(((bounds[..., 0] <= truth[new]) & (truth[new] <= bounds[..., 1])).mean(axis=1))
    return np.array(result), n


def main() -> int:
    """Print a line per dataset, method and level; return the exit status."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--splits", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    logging.disable(logging.INFO)  # MAPIE remarks on every corrected pair that crosses
    bad = 0
    print(f"{'dataset':<18}{'method':<12}{'level':>6}{'expected':>10}{'mean':>9}{'lowest':>9}{'in errors':>11}")
    for folder in sorted(path.parent for path in options.results.glob("*/table.parquet")):
        for method in (name for name, spec in INTERVAL_METHODS.items() if spec.guaranteed):
            shares, n = coverages(folder, method, options.splits, options.seed)
            means, errors = shares.mean(axis=0), shares.std(axis=0, ddof=1) / np.sqrt(options.splits)
            for place, level in enumerate(LEVELS):
                rank = conformal_rank(n, level)
                if rank is None:
                    continue
                worst = int(np.argmin(means[place]))
                distance = (means[place, worst] - level) / errors[place, worst]
                mark = "  BELOW" if distance < -3 else ""
                bad += bool(mark)
                numbers = f"{level:>6}{rank / (n + 1):>10.4f}{means[place].mean():>9.4f}{means[place, worst]:>9.4f}"
                print(f"{folder.name:<18}{method:<12}{numbers}{distance:>11.1f}{mark}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
