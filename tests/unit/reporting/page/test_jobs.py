from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.clocks import Used
from softkin.core.files import write_json
from softkin.reporting.page.jobs import N_SLOWEST, Job, duration, measured, slowest_grid


@pytest.fixture
def jobs(tmp_path: Path) -> list[Job]:
    jobs = []
    for seconds in range(1, 31):
        benchmark, record = tmp_path / f"{seconds}.tsv", tmp_path / f"{seconds}.json"
        benchmark.write_text(f"s\th:m:s\tmax_rss\tcpu_time\n{seconds}\t0:00:01\t99\t{seconds / 3}\n")
        log = tmp_path / f"{seconds}.log"
        if seconds > 1:
            log.write_text(f"INFO {Used(seconds / 2, 0.1, 100.0)}\n")
        write_json(record, {"n_trials": 30, "n_pruned": seconds})
        jobs.append(Job("fit_model" if seconds % 2 else "refit", "arm", "gp", benchmark, log, (record,)))
    return jobs


def test_the_slowest_come_first_with_their_trials(jobs: list[Job]) -> None:
    grid = slowest_grid(measured(jobs), {"gp": "Gaussian process"})
    assert len(grid.rows) == N_SLOWEST
    assert [cell.text for cell in grid.rows[0]] == [
        *("refit", "arm", "Gaussian process", "30.0", "15.0", "100", "30", "30", "–"),
    ]
    walls = [float(row[3].text) for row in grid.rows]
    assert walls == sorted(walls, reverse=True)


def test_duration_adds_up(jobs: list[Job]) -> None:
    text = duration(measured(jobs))
    assert text.startswith(
        "7 min 45 s in 30 measured jobs, added up (3 min 52 s of CPU), most of it in refit (4 min 0 s)"
    )


def test_a_job_of_all_models_without_records(jobs: list[Job]) -> None:
    whole = Job("score", "arm", "", jobs[0].benchmark, jobs[0].log)
    (row,) = slowest_grid(measured([whole]), {}).rows
    assert [cell.text for cell in row] == ["score", "arm", "all", "1.00", "–", "–", "–", "–", "–"]


def test_seconds_of_several_fits_add_up(jobs: list[Job], tmp_path: Path) -> None:
    for name, seconds in (("one.json", 1.5), ("two.json", 2.0)):
        write_json(tmp_path / name, {"fit_seconds": seconds})
    fit = Job("fit_model", "arm", "gp", jobs[0].benchmark, jobs[0].log, (tmp_path / "one.json", tmp_path / "two.json"))
    assert measured([fit])["fit_seconds"].tolist() == [3.5]
