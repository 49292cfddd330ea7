"""Measure the whole workflow on robots of many commands: ten models under 15 minutes and 4 GB?

    python -m benchmarks.commands [--commands 2 6 16 64] [--rows 10000] [--cores 2] [--keep FOLDER]

Makes for each number of commands a table of a bending arm of two markers, whose bending is a smooth random map of all
commands, and runs the default configuration on it with few trials, from retrieving to the report and the store. Prints
the wall and CPU seconds, the largest memory that any one process held, and the jobs that took longest and most. The
exit status is 1 where a robot takes longer than `--minutes` or more than `--gigabytes`, or a run fails.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from benchmarks.measured_run import measured_run, snakemake
from benchmarks.utilisation import jobs
from softkin.core.geometry.constant_curvature import from_arcs
from softkin.core.samples import command_columns, coordinate_columns

LENGTHS_MM = (100.0, 200.0)
NOISE_MM = 0.2
TRIALS = {"n_trials": 5, "n_outer_trials": 5, "n_quantile_trials": 5}


def arm(n_rows: int, n_commands: int) -> pd.DataFrame:
    """Commands in [-1, 1]; the arm bends by up to a radian either way and stretches by a tenth, each the hyperbolic
    tangent of a random mixture of all commands.
    """
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1, 1, (n_rows, n_commands))
    mixed = np.tanh(commands @ rng.standard_normal((n_commands, 3)) / np.sqrt(n_commands))
    whole = np.column_stack([mixed[:, :2], LENGTHS_MM[-1] * (1 + 0.1 * mixed[:, 2])])
    arcs = np.stack([whole * length / LENGTHS_MM[-1] for length in LENGTHS_MM], axis=1)
    positions = from_arcs(arcs).reshape(n_rows, -1)
    positions += NOISE_MM * rng.standard_normal(positions.shape)
    columns = [*command_columns(n_commands), *coordinate_columns(len(LENGTHS_MM))]
    return pd.DataFrame(np.hstack([commands, positions]), columns=columns)


def write_robot(folder: Path, n_rows: int, n_commands: int) -> Path:
    """The robot's file and a configuration that names it; the path of the latter."""
    name = f"arm_{n_commands}"
    arm(n_rows, n_commands).to_parquet(folder / f"{name}.parquet", index=False)
    entry: dict[str, Any] = {"title": f"{n_commands} commands", "format": "table_file", "position_unit": "mm"}
    entry |= {"file": str(folder / f"{name}.parquet"), "commands": "u[0-9]+", "positions": "m[0-9]+_[xyz]"}
    entry |= {"split": {"method": "random"}}
    configuration = folder / f"{name}.yaml"
    content = {"campaign": "commands", "datasets": [name], "sources": {name: entry}, "tuning": TRIALS}
    configuration.write_text(yaml.safe_dump(content))
    return configuration


def measure(folder: Path, n_commands: int, options: argparse.Namespace) -> bool:
    """Run the workflow on one robot and print what it took; whether it stayed within the limits."""
    configuration = write_robot(folder, options.rows, n_commands)
    arguments = ["--cores", str(options.cores), "--quiet", "all", "--configfile", str(configuration)]
    run = measured_run(snakemake(folder, *arguments))
    print(
        f"{n_commands} commands, {options.rows} rows: {run.wall:.0f} s, {run.cpu:.0f} s of CPU, "
        f"{run.gigabytes:.2f} GB at most, exit status {run.status}"
    )
    if run.status:
        return False
    table = jobs(folder / "results").round(2)
    for column, count in (("wall_s", 8), ("memory_mb", 4)):
        print(table.nlargest(count, column).to_string(index=False), flush=True)
    return bool(run.wall <= 60 * options.minutes and run.gigabytes <= options.gigabytes)


def main() -> int:
    """Measure robot by robot; the exit status is 1 if one of them went beyond the limits."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--commands", type=int, nargs="+", default=[2, 6, 16, 64])
    parser.add_argument("--rows", type=int, default=10_000)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--minutes", type=float, default=15.0, help="wall time of a robot at most")
    parser.add_argument("--gigabytes", type=float, default=4.0, help="memory of a process at most")
    parser.add_argument("--keep", type=Path, help="work in this folder and leave it")
    options = parser.parse_args()
    within = []
    for n_commands in options.commands:
        with tempfile.TemporaryDirectory() as temporary:
            folder = (options.keep or Path(temporary)) / str(n_commands)
            folder.mkdir(parents=True, exist_ok=True)
            within.append(measure(folder, n_commands, options))
    return int(not all(within))


if __name__ == "__main__":
    sys.exit(main())
