"""Measure how long the stand-ins of the default datasets take to simulate.

    python -m benchmarks.standins [--limit 60]

Simulates each with as many rows as config/datasets.yaml registers for the dataset in whose place it stands, one after
the other in one process, and prints the seconds, the extent of the last marker and, in total, whether they stay under
`--limit`: the exit status is 1 if not.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
import yaml

from softkin.core.clocks import stopwatch
from softkin.core.samples import EXTRAPOLATION, TRAIN
from softkin.data.standins.simulating import simulate

HOUSE = Path(__file__).parent.parent


def main() -> int:
    """Print a line per dataset and the total; return the exit status."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for all together")
    limit = parser.parse_args().limit
    sources = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]
    total = 0.0
    print(f"{'dataset':<18}{'stand-in':<26}{'rows':>6}{'seconds':>9}  last marker x, y, z (mm): lowest and highest")
    for dataset, source in sources.items():
        if "standin" not in source:  # a local file
            continue
        name = source["standin"]["robot"]
        with stopwatch() as watch:
            subsets = simulate(name, n_rows=source["rows"], seed=source["standin"]["seed"])
        total += watch.seconds
        last = np.vstack([subsets[subset].positions[:, -3:] for subset in (TRAIN, EXTRAPOLATION)])
        extent = f"{last.min(axis=0).round(0).astype(int)} {last.max(axis=0).round(0).astype(int)}"
        print(f"{dataset:<18}{name:<26}{sum(map(len, subsets.values())):>6}{watch.seconds:>9.1f}  {extent}")
    print(f"{'all':<18}{'':<26}{'':>6}{total:>9.1f}  limit {limit:g} s")
    return int(total > limit)


if __name__ == "__main__":
    sys.exit(main())
