"""How long the run took: the slowest jobs, and the sum of each stage."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pandas as pd

from softkin.core.clocks import used_by_log
from softkin.core.durations import readable
from softkin.core.files import read_json
from softkin.reporting.page.grid import Cell, Column, Grid, filtered_columns, number, number_columns
from softkin.reporting.tables.numbers import NOTHING

N_SLOWEST = 15


@dataclass(frozen=True, slots=True)
class Job:
    """One measured job: its rule, dataset and model (empty: all of them), Snakemake's benchmark file, its log, in which
    it says what it used, and the JSON files that the job wrote, if any: `n_trials` and `n_pruned` of a study,
    `fit_seconds` of a fit.
    """

    rule: str
    dataset: str
    model: str
    benchmark: Path
    log: Path
    records: tuple[Path, ...] = ()


def measured(jobs: Sequence[Job]) -> pd.DataFrame:
    """Columns rule, dataset, model, seconds, cpu_seconds and memory_mb (peak resident; NaN where the log is gone),
    ended (UTC), n_trials, n_pruned and fit_seconds (their sums over the job's records; NaN where not recorded), one row
    per job. Snakemake's own CPU seconds are samples of what is running, which miss what ends between two of them.
    """
    rows = []
    for job in jobs:
        seconds = float(pd.read_csv(job.benchmark, sep="\t")["s"].iloc[-1])
        used = used_by_log(job.log) if job.log.is_file() else None
        records = [read_json(record) for record in job.records]
        rows.append(
            {
                **{"rule": job.rule, "dataset": job.dataset, "model": job.model},
                "seconds": seconds,
                "cpu_seconds": used.cpu_seconds if used else float("nan"),
                "memory_mb": used.memory_mb if used else float("nan"),
                "ended": datetime.fromtimestamp(job.benchmark.stat().st_mtime, UTC),
                **{name: _sum(records, name) for name in ("n_trials", "n_pruned", "fit_seconds")},
            }
        )
    return pd.DataFrame(rows)


def _sum(records: Sequence[Mapping[str, Any]], name: str) -> float:
    values = [float(record[name]) for record in records if name in record]
    return sum(values) if values else float("nan")


def slowest_grid(times: pd.DataFrame, models: Mapping[str, str]) -> Grid:
    """The table of the slowest jobs, slowest first."""
    rows = []
    for row in times.nlargest(N_SLOWEST, "seconds").itertuples():
        trials = [NOTHING if math.isnan(n) else f"{n:.0f}" for n in (row.n_trials, row.n_pruned)]
        rows.append(
            [
                *(Cell(row.rule), Cell(row.dataset), Cell(models.get(row.model, "all"))),
                *map(number, (row.seconds, row.cpu_seconds, row.memory_mb)),
                *(*map(Cell, trials), number(row.fit_seconds)),
            ]
        )
    sentence = (
        f"The {len(rows)} jobs that took longest, of {len(times)} that were measured. A study fits its model once "
        "a trial and fold. CPU time far below wall time means that a job waited for its turn."
    )
    columns = [*filtered_columns("Job", "Robot"), Column("Model")]
    columns += number_columns(
        "Wall time (s)", "CPU time (s)", "Peak memory (MB)", "Trials", "Pruned", "Of it fitting (s)"
    )
    return Grid("slowest", "The slowest jobs", sentence, columns, rows)


def duration(times: pd.DataFrame) -> str:
    """'12 min 34 s in 80 measured jobs, added up (10 min 2 s of CPU), most of it in tune (8 min 1 s); ...'."""
    stages = times.groupby("rule")["seconds"].sum()
    total, cpu = readable(times["seconds"].sum()), readable(times["cpu_seconds"].sum())
    longest = f"{stages.idxmax()} ({readable(stages.max())})"
    first, last = (moment.strftime("%Y-%m-%d %H:%M") for moment in (times["ended"].min(), times["ended"].max()))
    return (
        f"{total} in {len(times)} measured jobs, added up ({cpu} of CPU), most of it in {longest}; by their files they "
        f"ended between {first} and {last} UTC"
    )
