from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import DataError
from softkin.core.files import read_json
from softkin.core.folds import grouped_folds
from softkin.core.samples import Samples
from softkin.models.quantile import QUANTILE_MODELS
from softkin.training.study import StudyFile, TuningSettings
from softkin.training.tune_quantiles import pinball_errors, some_coordinates, tune_quantiles
from tests.conftest import bending_arm

SETTINGS = TuningSettings(n_trials=2, n_folds=2, max_rows=40, seed=0)


def test_coordinates_are_few_moving_and_spread_over_the_robot() -> None:
    rows = bending_arm(50, n_commands=3, n_markers=7)
    kept = some_coordinates(rows)
    places = [int(np.flatnonzero((rows.positions == column[:, None]).all(axis=0))[0]) for column in kept.positions.T]
    assert places == [3, 20]
    assert some_coordinates(bending_arm(50)).positions.shape == (50, 2)
    with pytest.raises(DataError, match="no coordinate moves") as caught:
        some_coordinates(Samples(np.zeros((5, 1)), np.ones((5, 3))))
    assert caught.value.fix == "check the positions of `train`"


@pytest.mark.parametrize("name", QUANTILE_MODELS)
def test_the_loss_prefers_the_quantiles_of_the_noise(name: str) -> None:
    """Eighty trees beat two; the loss is in mm."""
    rows = bending_arm(120)
    folds = grouped_folds(rows.commands, 2, 0)
    spec = QUANTILE_MODELS[name]
    good, poor = (
        np.mean(list(pinball_errors(spec, {"n_estimators": n, "max_depth": 3}, rows, folds, 0, 1))) for n in (80, 2)
    )
    assert good < 0.7 * poor
    wide = Samples(rows.commands, 10 * rows.positions)
    scaled = np.mean(list(pinball_errors(spec, {"n_estimators": 2, "max_depth": 3}, wide, folds, 0, 1)))
    assert scaled == pytest.approx(10 * poor, rel=0.02)


@pytest.mark.parametrize("name", QUANTILE_MODELS)
def test_only_train_is_tuned_on(name: str, table: Path, garbage_table: Path, tmp_path: Path) -> None:
    best = []
    for place, path in enumerate((table, garbage_table)):
        folder = tmp_path / str(place)
        tune_quantiles(
            path,
            spec=QUANTILE_MODELS[name],
            settings=SETTINGS,
            file=StudyFile(folder / "study.journal", "code"),
            threads=1,
            parameters=folder / "parameters.json",
            trials=folder / "trials.csv",
        )
        best.append(read_json(folder / "parameters.json"))
        trials = pd.read_csv(folder / "trials.csv")
        assert len(trials) == 2
        assert best[-1]["cv_pinball_mm"] == pytest.approx(trials["score_mm"].min())
    assert {**best[0], "cpu_seconds": 0} == {**best[1], "cpu_seconds": 0}
