"""Measure how a dry run grows with the number of datasets: 1,000 of them in 90 s and 1.5 GB?

    python -m benchmarks.many_robots [--datasets 4 40 300 1000] [--published] [--seconds 90] [--gigabytes 1.5]

Writes a configuration with that many entries, one local file of a made-up robot behind all of them (`--published`:
copies of FINGER's entry, which the mirror or the internet must serve, or whose stand-in takes its place), and runs
`snakemake --dry-run` on it in an empty folder. Prints jobs, seconds, CPU seconds and megabytes of each, and the
exponent by which each grows between the last two. The exit status is 1 where the largest goes beyond `--seconds` or
`--gigabytes`.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from benchmarks.measured_run import HOUSE, Measured, measured_run, snakemake

EXAMPLE = HOUSE / "config" / "examples" / "bending_arm.csv"
COLUMNS = {"commands": "p[0-9]_bar", "positions": "(middle|tip)_[xyz]"}


def write_configuration(folder: Path, n_datasets: int, *, published: bool) -> Path:
    """A configuration of `n_datasets` entries that differ in their name and title alone; its path."""
    entry: dict[str, Any] = {"title": "Bending arm", "format": "table_file", "file": str(EXAMPLE), **COLUMNS}
    entry |= {"position_unit": "mm", "split": {"method": "random"}}
    if published:
        entry = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]["finger"]
    sources = {f"robot_{place}": entry | {"title": f"{entry['title']} {place}"} for place in range(n_datasets)}
    configuration = folder / "many.yaml"
    configuration.write_text(yaml.safe_dump({"datasets": list(sources), "sources": sources}))
    return configuration


def dry_run(n_datasets: int, *, published: bool) -> tuple[int, Measured]:
    """Number of jobs, and what the dry run took."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        configuration = write_configuration(folder, n_datasets, published=published)
        command = snakemake(folder, "--dry-run", "--quiet", "rules", "--configfile", str(configuration))
        with (folder / "output").open("w+") as output:
            run = measured_run(command, stdout=output)
            output.seek(0)
            total = re.search(r"^total\s+(\d+)", output.read(), re.MULTILINE)
    return int(total.group(1)) if total else 0, run


def exponents(counts: list[int], values: np.ndarray) -> list[float]:
    """Growth of each column of `values` (n_counts, n_columns) with the number of datasets, between the last two."""
    return list(np.log(values[-1] / values[-2]) / np.log(counts[-1] / counts[-2]))


def main() -> int:
    """Print a line per number of datasets and the exponents; the exit status is 1 beyond the limits."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--datasets", type=int, nargs="+", default=[4, 40, 300, 1000])
    parser.add_argument("--published", action="store_true", help="copies of FINGER's entry in place of a local file")
    parser.add_argument("--seconds", type=float, default=90.0, help="wall time of the largest at most")
    parser.add_argument("--gigabytes", type=float, default=1.5, help="memory of the largest at most")
    options = parser.parse_args()
    rows = []
    print(f"{'datasets':>9}{'jobs':>9}{'seconds':>9}{'CPU s':>9}{'MB':>9}")
    for n_datasets in options.datasets:
        n_jobs, run = dry_run(n_datasets, published=options.published)
        if run.status or not n_jobs:
            return 1
        rows.append([n_jobs, run.wall, run.cpu, 1000 * run.gigabytes])
        print(f"{n_datasets:>9}{n_jobs:>9}{run.wall:>9.1f}{run.cpu:>9.1f}{1000 * run.gigabytes:>9.0f}", flush=True)
    if len(rows) > 1:
        print("exponent ", *(f"{exponent:>8.2f}" for exponent in exponents(options.datasets, np.array(rows))))
    return int(run.wall > options.seconds or run.gigabytes > options.gigabytes)


if __name__ == "__main__":
    sys.exit(main())
