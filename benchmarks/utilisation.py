"""Measure how well a run uses the machine: CPU seconds of fits over cores x wall seconds, and the slowest jobs.

    python -m benchmarks.utilisation --cores 2 [--configfile config/test.yaml]
    python -m benchmarks.utilisation --results results

Runs the workflow from nothing in a temporary folder. CPU seconds are those of the tuning trials and of all fits, refits
among them, imports and file work left out, as each job read them off the system's clock and wrote them into its log.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pandas as pd

from softkin.core.clocks import used_by_log

HOUSE = Path(__file__).resolve().parent.parent
SLOWEST = 20


def jobs(results: Path) -> pd.DataFrame:
    """Columns job, rule, wall_s, cpu_s, fit_cpu_s, memory_mb: a row for each job of a finished run that left a log."""
    rows = []
    for log in sorted((results / "logs").rglob("*.log")):
        used = used_by_log(log)
        if used is None:
            raise SystemExit(f"{log}: the job has not ended; run the workflow to its end first")
        name = log.relative_to(results / "logs").with_suffix("")
        timing = results / "benchmarks" / name.with_suffix(".tsv")
        wall = float(pd.read_csv(timing, sep="\t")["s"].iloc[0]) if timing.is_file() else float("nan")
        row = {"job": name.as_posix(), "rule": name.parts[0], "wall_s": wall}
        rows.append(row | dict(zip(("cpu_s", "fit_cpu_s", "memory_mb"), used, strict=True)))
    return pd.DataFrame(rows)


def print_jobs(run: pd.DataFrame, cores: int, wall: float | None) -> None:
    """Print what a run used: in all, by rule, and by its slowest jobs."""
    cpu, fits = run["cpu_s"].sum(), run["fit_cpu_s"].sum()
    print(f"{len(run)} jobs, {cpu:.0f} s of CPU, {fits:.0f} s of it in fits ({fits / cpu:.3f})")
    if wall is not None:
        print(f"wall {wall:.0f} s on {cores} cores; fits take {fits / (cores * wall):.3f} of the machine, and all jobs")
        print(f"{cpu / (cores * wall):.3f}")
    by_rule = run.groupby("rule")[["wall_s", "cpu_s", "fit_cpu_s"]].sum().sort_values("cpu_s", ascending=False)
    print(by_rule.assign(jobs=run["rule"].value_counts()).round(1).to_string())
    print(run.drop(columns="rule").nlargest(SLOWEST, "cpu_s").round(1).to_string(index=False))


def main() -> None:
    """Run, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--configfile", nargs="*", default=[])
    parser.add_argument("--results", type=Path, help="print what this finished run used, and run nothing")
    options = parser.parse_args()
    if options.results:
        print_jobs(jobs(options.results), options.cores, None)
        return
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
        print(f"a second run, with nothing to do, takes {again:.1f} s")
        print_jobs(jobs(Path(folder) / "results"), options.cores, wall)


if __name__ == "__main__":
    main()
