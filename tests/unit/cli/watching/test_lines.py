from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli.watching.estimate import Remaining
from softkin.cli.watching.job import Job
from softkin.cli.watching.lines import ended_line, screen_lines, time_left
from softkin.cli.watching.progress import Progress


@pytest.fixture
def run(tmp_path: Path) -> Progress:
    """One study at its eighth trial beside a fit, one job done, one waiting."""
    log = tmp_path / "tune.log"
    log.write_text("2026-01-01 00:00:00,000 DEBUG trial 8 of 30: COMPLETE 1.2 {}\n")
    finger = {"dataset": "finger"}
    jobs = [
        Job("prepare", finger),
        Job("tune", finger | {"model": "gp"}, 600.0, log),
        Job("fit_paper", finger | {"model": "lr"}, 100.0),
    ]
    run = Progress(dict(enumerate([*jobs, Job("tune", finger | {"model": "lr"}, 100.0)])), 2, start=100.0)
    run.begin(0, 100.0)
    run.end(0, 102.0)
    run.begin(1, 110.0)
    run.begin(2, 120.0)
    return run


def test_the_screen_shows_stage_dataset_model_trials_and_times(run: Progress) -> None:
    lines = screen_lines(run, 190.0, title="softkin default", width=100, height=20)
    assert lines == [
        "softkin default · 1 of 4 jobs · 1 min 30 s used · roughly 9 min left",
        "[#######.......................]  tune 0/2, fit paper 0/1",
        "  tune       finger  gp  trial 8 of 30  1 min 20 s",
        "  fit paper  finger  lr                 1 min 10 s",
    ]


@pytest.mark.parametrize(("width", "height"), [(20, 3), (80, 24), (1, 1)])
def test_the_screen_keeps_within_the_terminal(run: Progress, width: int, height: int) -> None:
    lines = screen_lines(run, 190.0, title="softkin", width=width, height=height)
    assert len(lines) <= height
    assert all(len(line) <= width for line in lines)


def test_a_log_gets_one_line_for_a_job(run: Progress) -> None:
    job = run.end(2, 125.0)
    assert job is not None
    line = ended_line(job, run, 125.0, "14:03:12")
    assert line == "[14:03:12 · 2 of 4 jobs · 25 s used · roughly 2 min left] fit paper finger lr: 5.0 s"
    run.end(1, 130.0, failed=True)
    assert ended_line(run.jobs[1], run, 130.0, "14:03:17") == (
        "[14:03:17 · 2 of 4 jobs · 1 FAILED · 30 s used · under a minute left] tune finger gp: FAILED"
    )


@pytest.mark.parametrize(
    ("remaining", "expected"),
    [
        (Remaining(10.0, is_rough=True), "under a minute left"),
        (Remaining(10.0), "under a minute left"),
        (Remaining(840.0), "about 14 min left"),
        (Remaining(180.0, is_rough=True), "roughly 3 min left"),
    ],
)
def test_an_estimate_says_how_good_it_is(remaining: Remaining, expected: str) -> None:
    assert time_left(remaining) == expected
