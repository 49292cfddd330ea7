from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from softkin.campaigns.comparison import BETTER, COVERAGE, ERROR, SAME, WIDTH, WORSE, Comparison, Tolerances, compare

QUICK = Tolerances(resamples=999)
ROWS = 80


def night(
    seed: int,
    *,
    rows_seed: int = 0,
    factor: float = 1.0,
    coverage: float = 0.9,
    n: int = ROWS,
    datasets: Sequence[str] = ("finger", "arm"),
) -> pd.DataFrame:
    """Rows of datasets and two subsets: errors and hits drawn by `seed` around difficulties that rows have."""
    frames = []
    for place, (dataset, subset) in enumerate([(d, s) for d in datasets for s in ("test", "extrapolation")]):
        fixed, drawn = np.random.default_rng((rows_seed, place)), np.random.default_rng((seed, place))
        difficulty = fixed.exponential(size=n)
        hits = drawn.random((n, 3)) < coverage
        frame = {
            "dataset": dataset,
            "subset": subset,
            "row": [f"{rows_seed}-{i}" for i in range(n)],
            "command": [f"{rows_seed}-{i}" for i in range(n)],
            "error_mm": factor * difficulty * drawn.uniform(0.9, 1.1, size=n),
            "width_mm": 2.0 * drawn.uniform(0.99, 1.01, size=n),
            "covered": ["".join("01"[int(hit)] for hit in row) for row in hits],
        }
        frames.append(pd.DataFrame(frame))
    return pd.concat(frames, ignore_index=True)


def compared(before: pd.DataFrame, now: pd.DataFrame, tolerances: Tolerances = QUICK) -> list[Comparison]:
    rows = {"finger": 100, "arm": 100}
    return compare(before, now, confidence_level=0.9, calibration_rows=rows, tolerances=tolerances)


def test_the_same_night_is_the_same_everywhere() -> None:
    found = compared(night(0), night(0))
    assert len(found) == 2 * 2 * 3
    assert {(one.outcome, one.p_worse, one.paired) for one in found} == {(SAME, 1.0, True)}


def test_a_model_that_is_a_tenth_worse_is_found_and_named() -> None:
    now = night(1)
    now.loc[(now["dataset"] == "arm") & (now["subset"] == "test"), "error_mm"] *= 1.1
    worse = [one for one in compared(night(0), now) if one.outcome == WORSE]
    assert [(one.dataset, one.subset, one.metric) for one in worse] == [("arm", "test", ERROR)]
    assert worse[0].now == pytest.approx(1.1 * worse[0].before, rel=0.05)


def test_a_model_that_is_better_is_no_alarm() -> None:
    found = compared(night(0), night(1, factor=0.8))
    assert {one.outcome for one in found if one.metric == ERROR} == {BETTER}
    assert WORSE not in {one.outcome for one in found}


@pytest.mark.parametrize(
    "same_rows", [True, pytest.param(False, marks=pytest.mark.slow)], ids=["same rows", "other rows"]
)
def test_nights_in_which_only_noise_changes_alarm_in_one_of_twenty_at_most(same_rows: bool) -> None:
    """200 nights, each compared with the one before; the bound is the upper 1 % point of as many alarms at 5 %."""
    tolerances = Tolerances(resamples=499, error=0.0, coverage=0.0, width=0.0)
    alarms, before = 0, night(0, n=40, datasets=["finger"])
    for seed in range(1, 201):
        now = night(seed, rows_seed=0 if same_rows else seed, n=40, datasets=["finger"])
        alarms += any(one.outcome == WORSE for one in compared(before, now, tolerances))
        before = now
    assert alarms <= stats.binom(200, 0.05).ppf(0.99)


@pytest.mark.parametrize("same_rows", [True, False], ids=["same rows", "other rows"])
def test_intervals_that_cover_less_are_found(same_rows: bool) -> None:
    found = compared(night(0, n=400), night(1, rows_seed=0 if same_rows else 1, coverage=0.7, n=400))
    assert {one.outcome for one in found if one.metric == COVERAGE} == {WORSE}


def test_a_coverage_that_dropped_and_is_still_what_was_promised_is_no_alarm() -> None:
    found = compared(night(0, coverage=1.0, n=400), night(1, coverage=0.9, n=400))
    assert {one.outcome for one in found if one.metric == COVERAGE} == {SAME}


def test_an_interval_that_became_infinite_is_worse() -> None:
    now = night(0)
    now.loc[now["dataset"] == "arm", "width_mm"] = np.inf
    outcomes = {(one.dataset, one.metric): one.outcome for one in compared(night(0), now) if one.subset == "test"}
    assert outcomes["arm", WIDTH] == WORSE
    assert outcomes["finger", WIDTH] == SAME
    assert all(
        None in one.as_dict().values()
        for one in compared(night(0), now)
        if one.dataset == "arm" and one.metric == WIDTH
    )


def test_copies_of_a_command_count_once_and_few_commands_not_at_all() -> None:
    few = night(0, n=9)
    assert {one.outcome for one in compared(few, few.assign(error_mm=9.0))} == {SAME}
    copied = pd.concat([few.assign(row=[f"{row}-{copy}" for row in few["row"]]) for copy in range(20)])
    assert {one.outcome for one in compared(copied, copied.assign(error_mm=9.0))} == {SAME}
    assert {one.n_commands for one in compared(copied, copied)} == {9}


def test_datasets_that_one_of_the_two_has_are_left_out() -> None:
    now = night(0)
    assert {one.dataset for one in compared(night(0), now[now["dataset"] == "arm"])} == {"arm"}
