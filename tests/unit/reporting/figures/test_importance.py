"""Importance of parameters."""

from __future__ import annotations

import numpy as np
import pandas as pd
from sklearn.ensemble import RandomForestRegressor
from sklearn.inspection import permutation_importance

from softkin.reporting.figures.importance import N_REPEATS, frame, permutation_drops, plot
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.drawn import bars


def test_the_parameter_that_decides_comes_first_and_short_studies_are_left_out(results: DatasetResults) -> None:
    rows = frame(results)
    assert set(rows["model"]) == {"gb"}  # gp has nine trials
    assert rows["parameter"].iloc[0] == "rate"
    assert set(rows["parameter"]) == {"rate", "kind", "depth"}  # one never changed
    assert rows["importance"].iloc[0] > 5 * rows["importance"].iloc[1]
    assert set(rows["n_trials"]) == {30}  # pruned ones among them


def test_bars_are_as_long_as_the_importance(results: DatasetResults) -> None:
    rows = frame(results)
    axes = plot(rows, results).axes[0]
    np.testing.assert_allclose([right for _, right in bars(axes)], rows["importance"])
    assert [text.get_text() for text in axes.get_yticklabels()] == rows["parameter"].tolist()


def test_trials_that_are_all_alike_say_nothing(results: DatasetResults) -> None:
    for path in results.trials.values():
        study = pd.read_csv(path)
        study[["param_kind", "param_depth", "param_rate"]] = 1.0
        study.to_csv(path, index=False)
    assert frame(results).empty


def test_drops_are_those_of_scikit_learn_to_the_bit() -> None:
    rng = np.random.default_rng(0)
    numbers, score = rng.standard_normal((40, 3)), rng.standard_normal(40)
    numbers[::3, 1] = np.nan
    forest = RandomForestRegressor(32, random_state=0).fit(numbers, score)
    theirs = permutation_importance(forest, numbers, score, n_repeats=N_REPEATS, random_state=0)
    np.testing.assert_array_equal(permutation_drops(numbers, score), theirs.importances)
