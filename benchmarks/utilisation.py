"""Measure how well a run uses the machine: CPU seconds of fits over cores x wall seconds, and the ten slowest jobs.

    python -m benchmarks.utilisation --cores 2 [--configfile config/test.yaml]

Runs the workflow from nothing in a temporary folder (the default configuration takes a quarter of an hour on two
cores). CPU seconds are those of the tuning trials and of the fits themselves, imports and file work left out.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.core.files import read_json

HOUSE = Path(__file__).resolve().parent.parent
INTERVAL_RULES = ("tune_quantiles", "fit_quantiles", "refit", "calibrate_intervals", "score_intervals")


def fit_cpu_seconds(results: Path) -> float:
    """CPU seconds of trials, fits and refits."""
    seconds = sum(float(read_json(path)["cpu_seconds"]) for path in results.glob("**/tuned/parameters.json"))
    seconds += sum(float(read_json(path)["fit_cpu_seconds"]) for path in results.glob("**/fit.json"))
    for path in results.glob("*/refits.npz"):
        with np.load(path) as archive:
            seconds += float(archive["fit_cpu_seconds"])
    return seconds


def interval_share(benchmarks: Path) -> float:
    """CPU seconds of the interval rules over those of all other rules that are benchmarked."""
    seconds = {True: 0.0, False: 0.0}
    for path in benchmarks.rglob("*.tsv"):
        rule = path.relative_to(benchmarks).parts[0]
        seconds[rule in INTERVAL_RULES] += float(pd.read_csv(path, sep="\t")["cpu_time"].iloc[0])
    return seconds[True] / seconds[False]


def slowest_jobs(benchmarks: Path, count: int = 10) -> pd.DataFrame:
    """The jobs of longest wall time, from Snakemake's own benchmark files."""
    rows = []
    for path in benchmarks.rglob("*.tsv"):
        timing = pd.read_csv(path, sep="\t").iloc[0]
        rows.append({"job": path.relative_to(benchmarks).with_suffix("").as_posix(), "wall_s": timing["s"]})
    return pd.DataFrame(rows).nlargest(count, "wall_s").round(1)


def main() -> None:
    """Run, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--configfile", nargs="*", default=[])
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "snakemake", "--cores", str(options.cores), "--directory", folder]
        command += ["--snakefile", str(HOUSE / "Snakefile"), "--quiet", "all"]
        if options.configfile:
            command += ["--configfile", *(str(Path(path).resolve()) for path in options.configfile)]
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        start = time.perf_counter()
        subprocess.run(command, check=True, cwd=HOUSE, env=os.environ | {"PATH": path})
        wall = time.perf_counter() - start
        start = time.perf_counter()
        subprocess.run(command, check=True, cwd=HOUSE, env=os.environ | {"PATH": path})
        again = time.perf_counter() - start
        cpu = fit_cpu_seconds(Path(folder) / "results")
        print(f"wall {wall:.0f} s on {options.cores} cores; a second run, with nothing to do, {again:.1f} s")
        print(f"CPU of fits {cpu:.0f} s; share of the machine {cpu / (options.cores * wall):.3f}")
        added = interval_share(Path(folder) / "results" / "benchmarks")
        print(f"interval work adds {added:.1%} to the CPU time of the other benchmarked rules")
        print(slowest_jobs(Path(folder) / "results" / "benchmarks").to_string(index=False))


if __name__ == "__main__":
    main()
