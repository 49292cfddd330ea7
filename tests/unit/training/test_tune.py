from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import DataError
from softkin.core.files import read_json
from softkin.core.runs import OUTER, TUNED
from softkin.core.samples import Samples
from softkin.data.table import to_table, write_table
from softkin.models import MODELS
from softkin.models.spec import ModelSpec
from softkin.training.held_out import SCORES, Robot, read_held_out
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.selection import OBJECTIVES, deployed, searched_runs, selection
from softkin.training.study import TuningResult, TuningSettings
from softkin.training.tune import PresetFiles, SearchSettings, other_space, possible_spaces, tune_table
from tests.conftest import bending_arm

ROBOT = Robot(base=None, standardised_norm=False)
SPACES = ["cartesian", "curvature"]


def two_link_arm(n: int, seed: int = 0) -> Samples:
    """Rigid links of 100 and 80 mm in a plane, the joint angles as commands; some positions lie behind the base."""
    commands = np.random.default_rng(seed).uniform(-2.4, 2.4, (n, 2))
    first, second = commands[:, 0], commands.sum(axis=1)
    x, y = 100 * np.cos(first) + 80 * np.cos(second), 100 * np.sin(first) + 80 * np.sin(second)
    return Samples(commands, np.column_stack([x, y, np.zeros(n)]))


def tuned(samples: Samples, model: str, folder: Path, n_trials: int = 8) -> dict[str, dict[str, Any]]:
    """The best parameters of the studies of both presets, by preset."""
    table = folder / "table.parquet"
    write_table(to_table(dict.fromkeys(("train", "validation", "test", "extrapolation"), samples)), table)
    presets = (TUNED, OUTER)
    endings = ("journal", "json", "csv", "npz")
    files = {preset: PresetFiles(*(folder / f"{preset}.{ending}" for ending in endings)) for preset in presets}
    tune_table(
        table,
        spec=MODELS[model],
        robot=ROBOT,
        settings=TuningSettings(n_trials=n_trials, n_folds=4, max_rows=400, seed=0),
        search=SearchSettings(dict.fromkeys(presets, n_trials), presets, 3, [0.5, 0.75], SPACES),
        files=files,
        code="",
        threads=1,
    )
    for preset in presets:
        assert len(pd.read_csv(files[preset].trials)) == n_trials
        best = read_json(files[preset].parameters)
        scored = {by for by, score in SCORES.items() if best[score] is not None}
        assert set(read_held_out(files[preset].held_out)) == scored
    return {preset: read_json(files[preset].parameters) for preset in presets}


def test_an_arm_that_bends_in_arcs_gets_curvature_coordinates(tmp_path: Path) -> None:
    by_preset = tuned(bending_arm(120, n_markers=2), "lr", tmp_path)
    assert by_preset[OUTER]["target_space"] == "curvature"
    other = by_preset[OUTER]["other_space"]
    assert other["target_space"] == "cartesian"
    assert other["shell_mae_mm"] >= by_preset[OUTER]["shell_mae_mm"]
    assert set(other["params"]) == set(by_preset[OUTER]["params"])
    assert "other_space" not in by_preset[TUNED]
    for scores in by_preset.values():
        assert 0 <= scores["cv_mae_mm"] < np.inf
        assert 0 <= scores["shell_mae_mm"] < np.inf
    assert by_preset[OUTER]["shell_mae_mm"] <= by_preset[TUNED]["shell_mae_mm"]
    assert by_preset[TUNED]["cv_mae_mm"] <= by_preset[OUTER]["cv_mae_mm"]


def test_what_both_studies_draw_is_fitted_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first four trials of either study are the same; each part of them, of either preset, is fitted once."""
    fitted: list[tuple[str, int]] = []

    def counted(spec: ModelSpec, settings: FitSettings, samples: Samples) -> Any:
        fitted.append((f"{settings.params} {settings.target_space}", hash(samples.commands.tobytes())))
        return fitted_model(spec, settings, samples)

    monkeypatch.setattr("softkin.training.held_out.fitted_model", counted)
    tuned(bending_arm(80), "lr", tmp_path, n_trials=4)
    assert len(fitted) == len(set(fitted))


def test_parameters_of_many_commands_are_recorded_as_the_smallest_part_has_them(tmp_path: Path) -> None:
    """120 rows: 90 in each fold, 60 in the smaller core; degree 2 of 12 commands has 90 terms."""
    by_preset = tuned(bending_arm(120, n_commands=12), "ridge", tmp_path, n_trials=3)
    assert by_preset[TUNED]["params"]["degree"] == 2
    assert "interactions" not in by_preset[TUNED]["params"]
    assert by_preset[OUTER]["params"]["degree"] == 2
    assert by_preset[OUTER]["params"]["interactions"] is False


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_a_rigid_arm_of_two_links_gets_positions(objective: str, two_links: pd.DataFrame) -> None:
    """By the run that is chosen; a poor model may be less poor in arcs."""
    chosen = deployed(selection(two_links, objective)).iloc[0]
    assert (chosen["model"], chosen["target_space"]) == ("gp", "cartesian")


@pytest.fixture(scope="module")
def two_links(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    files: dict[tuple[str, str, str], str | Path] = {}
    for model in ("gp", "ridge"):
        folder = tmp_path_factory.mktemp(model)
        tuned(two_link_arm(200), model, folder)
        files |= {("arm", model, preset): folder / f"{preset}.json" for preset in (TUNED, OUTER)}
    return searched_runs(files)


def test_a_space_that_does_not_hold_the_robot_is_left_out_and_an_empty_choice_is_an_error() -> None:
    behind = Samples(np.arange(4.0)[:, None], np.array([[0.0, 0.0, -z] for z in (5.0, 6.0, 7.0, 8.0)]))
    declared = replace(ROBOT, base={"origin": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0]})
    assert possible_spaces(behind, SPACES, declared) == ["cartesian"]
    with pytest.raises(DataError, match=r"(?s)4 positions lie at the base or straight behind it.*declare `base`"):
        possible_spaces(behind, ["curvature"], declared)


def test_the_other_space_is_that_of_the_best_trial_in_another_one() -> None:
    trials = [({"target_space": space, "degree": degree}, score) for space, degree, score in (
        ("curvature", 1, 0.1), ("curvature", 2, 0.2), ("cartesian", 3, 0.3), ("cartesian", 1, 0.4)
    )]  # fmt: skip
    result = TuningResult(*trials[0], pd.DataFrame(), "", trials)
    assert other_space(result) == {
        "target_space": "cartesian",
        "memory": None,
        "params": {"degree": 3},
        "shell_mae_mm": 0.3,
    }
    assert other_space(replace(result, complete=trials[:2])) is None
