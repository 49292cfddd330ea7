"""Write resources/timings.csv: what each job of a finished run of the default configuration took.

    python -m tools.timings [--folder .] [--file resources/timings.csv]

`folder` is where the run was made: jobs are those of results/logs, and CPU seconds what each says there that it used.
Wall seconds are those of results/benchmarks, and where a rule has no benchmark those of Snakemake's own records. Make
the run alone on its machine, from nothing.
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

from softkin.cli.watching.timings import ANY, Timing, benchmark_row
from softkin.core.clocks import used_by_log
from softkin.core.errors import SoftkinError
from softkin.core.files import read_json, replacing

LOGS, BENCHMARKS = Path("results") / "logs", Path("results") / "benchmarks"
RECORDS = Path(".snakemake") / "metadata"


def write_timings(folder: Path, file: Path) -> int:
    """Write the timings of the run in `folder` into `file`; return how many jobs there are.

    Raises:
        SoftkinError: there is no job, or one that was not timed.
    """
    recorded = _recorded(folder / RECORDS)
    rows = sorted(_timing(folder, log.relative_to(folder), recorded) for log in (folder / LOGS).rglob("*.log"))
    if not rows:
        raise SoftkinError("no log of a job", where=folder / LOGS, fix="run the workflow to its end: make run")
    with replacing(file) as temporary, temporary.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(Timing._fields)
        writer.writerows(rows)
    return len(rows)


def _timing(folder: Path, log: Path, recorded: dict[str, float]) -> Timing:
    """The timing of the job that wrote `log`."""
    place = log.relative_to(LOGS).with_suffix(".tsv")
    rule, *wildcards = place.with_suffix("").parts
    dataset, model = (wildcards or [ANY])[0], "/".join(wildcards[1:]) or ANY
    row = benchmark_row(folder / BENCHMARKS / place)
    if row is None and str(log) not in recorded:
        raise SoftkinError("this job was not timed", where=folder / log, fix="delete results, and run it all again")
    wall, used = row["s"] if row else recorded[str(log)], used_by_log(folder / log)
    return Timing(rule, dataset, model, f"{float(wall):.1f}", f"{used.cpu_seconds:.1f}" if used else "")


def _recorded(records: Path) -> dict[str, float]:
    """Log -> wall seconds until the last output of its job, by Snakemake's records, one for each output."""
    seconds: dict[str, float] = {}
    for path in records.rglob("*"):
        if path.is_file():
            record = read_json(path)
            for log in record["log"]:
                seconds[log] = max(seconds.get(log, 0.0), record["endtime"] - record["starttime"])
    return seconds


def main() -> int:
    """Print how many jobs there are, or the error; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, default=Path())
    parser.add_argument("--file", type=Path, default=Path("resources") / "timings.csv")
    options = parser.parse_args()
    try:
        print(f"{options.file}: {write_timings(options.folder, options.file)} jobs")
    except SoftkinError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
