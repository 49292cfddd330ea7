from __future__ import annotations

from pathlib import Path

import pytest

from softkin.cli.watching.study_log import TAIL_BYTES, study_seconds_left, trials


def trial(second: float, done: int, total: int) -> str:
    minutes, seconds = divmod(second, 60.0)
    return (
        f"2026-01-01 00:{int(minutes):02}:{seconds:06.3f} DEBUG trial {done} of {total}: COMPLETE 1.2 {{}}\n".replace(
            ".", ",", 1
        )
    )


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return tmp_path / "tune.log"


def test_the_last_trial_is_how_far_a_study_is(log: Path) -> None:
    log.write_text("2026-01-01 00:00:00,000 INFO resuming after 2 of 8 trials\n")
    assert trials(log) == (2, 8)
    log.write_text(trial(1.0, 4, 8) * 500)
    assert trials(log) == (4, 8)


@pytest.mark.parametrize("text", ["", "2026-01-01 00:00:00,000 INFO fitted on 120 rows in 0.2 s\n"])
def test_a_log_without_trials_has_none(log: Path, text: str) -> None:
    log.write_text(text)
    for file in (log, log.with_name("missing.log"), None):
        assert trials(file) is None
        assert study_seconds_left(file) == 0.0


def test_trials_to_come_take_as_long_as_those_before(log: Path) -> None:
    log.write_text("".join(trial(10.0 + 2.0 * done, done, 30) for done in range(1, 11)))
    assert study_seconds_left(log) == pytest.approx(40.0)


def test_one_trial_alone_has_no_pace(log: Path) -> None:
    log.write_text(trial(10.0, 1, 30))
    assert study_seconds_left(log) == 0.0


@pytest.mark.parametrize("total", [30, 8])
def test_the_study_before_is_another(log: Path, total: int) -> None:
    first = "".join(trial(float(done), done, 30) for done in range(1, 31))
    log.write_text(first + trial(70.0, 1, total) + trial(75.0, 2, total))
    assert study_seconds_left(log) == pytest.approx(5.0 * (total - 2))


def test_the_tail_of_a_long_log_is_enough(log: Path) -> None:
    log.write_text("".join(trial(0.5 * done, done, 1000) for done in range(1, 801)))
    assert log.stat().st_size > 5 * TAIL_BYTES
    assert study_seconds_left(log) == pytest.approx(100.0)
