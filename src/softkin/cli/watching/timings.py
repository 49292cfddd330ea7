"""What jobs took: in the run before, by its benchmark files, and by the timings that softkin ships."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path
from statistics import median
from typing import NamedTuple, Self

from softkin.core.errors import SoftkinError

#: In place of a dataset or a model: the job belongs to no single one.
ANY = "*"


class Timing(NamedTuple):
    """A row of the timings: what a job took.

    `dataset` is `*` for a job on all datasets, `model` is `*` for a job that has no wildcard besides its dataset;
    several are joined by '/', as in 'gb/tuned'. `cpu_seconds` is empty where they were not measured.
    """

    rule: str
    dataset: str
    model: str
    wall_seconds: str
    cpu_seconds: str


class Timings:
    """Wall seconds by rule, dataset and model."""

    def __init__(self, rows: Iterable[Timing]) -> None:
        self._seconds = {row[:3]: float(row.wall_seconds) for row in rows}

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """The timings of a CSV file with the columns of `Timing`.

        Raises:
            SoftkinError: the file is missing, has other columns, no row, or a value that is no number.
        """
        fix = "restore resources/timings.csv from the repository"
        try:
            with Path(path).open(encoding="utf-8", newline="") as file:
                header, *rows = csv.reader(file)
            if header != list(Timing._fields) or not rows:
                raise SoftkinError(f"no timings with the columns {', '.join(Timing._fields)}", where=path, fix=fix)
            return cls(Timing(*row) for row in rows)
        except (FileNotFoundError, TypeError, ValueError) as error:
            raise SoftkinError(f"no timings: {error}", where=path, fix=fix) from error

    def seconds(self, rule: str, wildcards: Mapping[str, str]) -> float:
        """What a job takes.

        Where it was never timed: the median of its rule and model over datasets, or of its rule, or of all jobs.
        """
        dataset, model = dataset_and_model(wildcards)
        keys = list(self._seconds)
        alike = (
            [key for key in keys if key == (rule, dataset, model)],
            [key for key in keys if (key[0], key[2]) == (rule, model)],
            [key for key in keys if key[0] == rule],
            keys,
        )
        return median(self._seconds[key] for key in next(found for found in alike if found))


def dataset_and_model(wildcards: Mapping[str, str]) -> tuple[str, str]:
    """The columns `dataset` and `model` of a job's timing."""
    others = [value for name, value in wildcards.items() if name != "dataset"]
    return wildcards.get("dataset", ANY), "/".join(others) or ANY


def measured_seconds(benchmark: str | Path | None) -> float | None:
    """Wall seconds in a benchmark file of Snakemake's; None when there is none."""
    row = benchmark_row(benchmark)
    return float(row["s"]) if row else None


def benchmark_row(benchmark: str | Path | None) -> dict[str, str] | None:
    """The last row of a benchmark file of Snakemake's; None when there is none."""
    if benchmark is None or not Path(benchmark).is_file():
        return None
    with Path(benchmark).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    return rows[-1] if rows else None
