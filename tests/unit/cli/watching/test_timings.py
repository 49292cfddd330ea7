from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli.watching.timings import Timing, Timings, benchmark_row, measured_seconds
from softkin.core.errors import SoftkinError

ROWS = [
    Timing("tune", "finger", "gp", "30.0", "28.0"),
    Timing("tune", "abaqus", "gp", "90.0", "85.0"),
    Timing("tune", "finger", "lr", "4.0", "3.5"),
    Timing("fit_quantiles", "finger", "gb/tuned", "6.0", ""),
    Timing("build_report", "*", "*", "9.0", "8.0"),
]


def test_a_job_takes_what_it_was_timed_at() -> None:
    timings = Timings(ROWS)
    assert timings.seconds("tune", {"dataset": "abaqus", "model": "gp"}) == 90.0
    assert timings.seconds("fit_quantiles", {"dataset": "finger", "quantile_model": "gb", "preset": "tuned"}) == 6.0
    assert timings.seconds("build_report", {}) == 9.0


@pytest.mark.parametrize(
    ("rule", "wildcards", "seconds"),
    [
        ("tune", {"dataset": "arm", "model": "gp"}, 60.0),  # of the model, on other robots
        ("tune", {"dataset": "finger", "model": "new"}, 30.0),  # of the rule
        ("new", {"dataset": "finger"}, 9.0),  # of all
    ],
)
def test_a_job_that_was_never_timed_takes_the_median_of_those_most_like_it(
    rule: str, wildcards: dict[str, str], seconds: float
) -> None:
    assert Timings(ROWS).seconds(rule, wildcards) == seconds


def test_timings_are_read_from_their_columns(tmp_path: Path) -> None:
    file = tmp_path / "timings.csv"
    file.write_text("rule,dataset,model,wall_seconds,cpu_seconds\ntune,finger,gp,30.0,28.0\naudit,finger,*,3.0,\n")
    assert Timings.read(file).seconds("audit", {"dataset": "finger"}) == 3.0


@pytest.mark.parametrize(
    "text",
    [
        None,
        "",
        "rule,seconds\ntune,3\n",
        "rule,dataset,model,wall_seconds,cpu_seconds\n",
        "rule,dataset,model,wall_seconds,cpu_seconds\ntune,finger,gp,long,\n",
        "rule,dataset,model,wall_seconds,cpu_seconds\ntune,finger\n",
    ],
)
def test_a_file_without_timings_is_refused_by_name(tmp_path: Path, text: str | None) -> None:
    file = tmp_path / "timings.csv"
    if text is not None:
        file.write_text(text)
    with pytest.raises(SoftkinError) as refused:
        Timings.read(file)
    assert refused.value.where == str(file)
    assert "restore" in str(refused.value.fix)


def test_a_benchmark_is_read_by_its_last_row(tmp_path: Path) -> None:
    file = tmp_path / "gp.tsv"
    file.write_text("s\th:m:s\tcpu_time\n3.5\t0:00:03\t-\n4.25\t0:00:04\t1.0\n")
    assert measured_seconds(file) == 4.25
    assert benchmark_row(file) == {"s": "4.25", "h:m:s": "0:00:04", "cpu_time": "1.0"}
    for missing in (tmp_path / "none.tsv", None):
        assert measured_seconds(missing) is None
        assert benchmark_row(missing) is None
