"""Measure the time and memory of prepare and audit on a large robot: under a minute and 2 GB?

    python -m benchmarks.large [--rows 1000000] [--commands 6] [--markers 10] [--format parquet] [--keep FOLDER]

Writes a table of a made-up robot as a local file, Parquet or CSV, and runs the real workflow on it, one job after the
other, up to the data card. Prints the wall and CPU seconds of the whole call, and the largest memory that any
one process of it held (Snakemake, retrieve, prepare, audit). The exit status is 1 beyond `--limit` seconds or 2 GB.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import yaml

from benchmarks.audit import made_up
from softkin.data.table import to_table

HOUSE = Path(__file__).resolve().parent.parent
GIGABYTES = 2.0


def write_robot(folder: Path, options: argparse.Namespace) -> Path:
    """The robot's file and a configuration that names it; the path of the latter."""
    subsets = made_up(options.rows, options.commands, options.markers)
    table = to_table(subsets).drop(columns="subset").sample(frac=1.0, random_state=0)
    file = folder / f"large.{options.format}"
    if options.format == "csv":
        table.to_csv(file, index=False, float_format="%.6g")
    else:
        table.to_parquet(file, index=False)
    entry: dict[str, Any] = {"title": "Large", "format": "table_file", "file": str(file), "position_unit": "mm"}
    entry |= {"commands": "u[0-9]+", "positions": "m[0-9]+_[xyz]", "split": {"method": "random"}}
    configuration = folder / "large.yaml"
    configuration.write_text(yaml.safe_dump({"datasets": ["large"], "sources": {"large": entry}}))
    print(f"{file.name}: {options.rows} rows, {file.stat().st_size / 1e6:.0f} MB")
    return configuration


def main() -> int:
    """Run, measure, print; the exit status is 1 beyond the limits."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rows", type=int, default=1_000_000)
    parser.add_argument("--commands", type=int, default=6)
    parser.add_argument("--markers", type=int, default=10)
    parser.add_argument("--format", choices=["parquet", "csv"], default="parquet")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for all together")
    parser.add_argument("--keep", type=Path, help="work in this folder and leave it")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        configuration = write_robot(folder, options)
        command = [sys.executable, "-m", "snakemake", "--cores", "1", "--snakefile", str(HOUSE / "Snakefile")]
        command += ["--directory", str(folder), "--nolock", "results/large/data_card.json"]
        start = time.perf_counter()
        run = subprocess.run([*command, "--configfile", str(configuration)], cwd=HOUSE, check=False)
        seconds = time.perf_counter() - start
    if run.returncode:
        return run.returncode
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    gigabytes = used.ru_maxrss / 1024**2
    cpu = used.ru_utime + used.ru_stime
    print(f"{options.format}: {seconds:.1f} s together ({cpu:.1f} s of CPU), {gigabytes:.2f} GB at most")
    return int(seconds > options.limit or gigabytes > GIGABYTES)


if __name__ == "__main__":
    sys.exit(main())
