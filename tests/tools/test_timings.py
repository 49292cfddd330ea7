from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from softkin.cli.watching.timings import Timings
from softkin.core.clocks import Used
from tools.timings import main

BENCHMARK = "s\th:m:s\tmax_rss\tcpu_time\n{}\t0:00:03\t214.98\t1.5\n"


def write(path: Path, text: str = "") -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """A finished run: a study, a fit, a report and a preparation without benchmark, whose two outputs are recorded."""
    results = tmp_path / "run" / "results"
    for job, seconds, cpu in (
        ("tune/finger/gp", "31.44", 29.5),
        ("fit_quantiles/finger/gb/tuned", "2.5", None),
        ("build_report", "9.26", 8.04),
    ):
        write(results / "logs" / f"{job}.log", f"INFO {Used(cpu, 1.0, 200.0)}\n" if cpu else "")
        write(results / "benchmarks" / f"{job}.tsv", BENCHMARK.format(seconds))
    write(results / "logs" / "prepare" / "finger.log")
    for name, end in (("first", 101.0), ("second", 103.5)):
        record = {"rule": "prepare", "log": ["results/logs/prepare/finger.log"], "starttime": 100.0, "endtime": end}
        write(tmp_path / "run" / ".snakemake" / "metadata" / name, json.dumps(record))
    return tmp_path / "run"


def timed(run: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[int, Path]:
    file = run / "timings.csv"
    monkeypatch.setattr(sys, "argv", ["timings", "--folder", str(run), "--file", str(file)])
    return main(), file


def test_each_job_is_a_row_that_the_view_reads(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    status, file = timed(run, monkeypatch)
    assert status == 0
    assert file.read_text().splitlines() == [
        "rule,dataset,model,wall_seconds,cpu_seconds",
        "build_report,*,*,9.3,8.0",
        "fit_quantiles,finger,gb/tuned,2.5,",
        "prepare,finger,*,3.5,",
        "tune,finger,gp,31.4,29.5",
    ]
    timings = Timings.read(file)
    assert timings.seconds("tune", {"dataset": "finger", "model": "gp"}) == 31.4
    assert timings.seconds("fit_quantiles", {"dataset": "finger", "quantile_model": "gb", "preset": "tuned"}) == 2.5
    assert timings.seconds("build_report", {}) == 9.3


def test_a_job_that_was_not_timed_is_an_error(
    run: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write(run / "results" / "logs" / "audit" / "finger.log")
    assert timed(run, monkeypatch)[0] == 1
    assert "audit/finger.log: this job was not timed" in capsys.readouterr().err


def test_a_folder_without_a_run_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    status, file = timed(tmp_path, monkeypatch)
    assert status == 1
    assert not file.exists()
    assert "make run" in capsys.readouterr().err
