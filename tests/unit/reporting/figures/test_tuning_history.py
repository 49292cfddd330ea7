"""History of the studies."""

from __future__ import annotations

from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.tuning_history import frame, plot
from tests.unit.reporting.figures.drawn import xs


def test_the_best_so_far_never_gets_worse_and_pruned_trials_are_left_out(results: DatasetResults) -> None:
    rows = frame(results)
    assert rows.groupby("model", sort=False).size().to_dict() == {"gb": 20, "gp": 6}
    for _, study in rows.groupby("model"):
        assert study["best_mm"].is_monotonic_decreasing
        assert study["best_mm"].iloc[-1] == study["score_mm"].min()
        assert 2 not in set(study["trial"])


def test_the_line_of_a_short_study_goes_on_to_the_last_trial_of_all(results: DatasetResults) -> None:
    rows = frame(results)
    steps = [line for line in plot(rows, results).axes[0].lines if line.get_drawstyle() == "steps-post"]
    assert {xs(line)[-1] for line in steps} == {rows["trial"].max()}
