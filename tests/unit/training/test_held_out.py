from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.folds import Folds, grouped_folds
from softkin.core.runs import OUTER, TUNED
from softkin.core.samples import Params, Samples
from softkin.models import MODELS
from softkin.training.held_out import (
    HeldOut,
    PartSettings,
    Robot,
    mean_error,
    parts_of,
    read_held_out,
    some_markers,
    truth_of,
    write_held_out,
)
from tests.conftest import bending_arm

ROBOT = Robot(base=None, standardised_norm=False)
SETTINGS = PartSettings(n_folds=4, core_shares=(0.5, 0.75), max_rows=60, max_markers=1, scores=(TUNED, OUTER), seed=0)
LINE: Params = {"degree": 1, "target_space": "cartesian"}


def errors(model: str, params: Params, rows: Samples, folds: Folds, robot: Robot = ROBOT) -> list[float]:
    return list(HeldOut(MODELS[model], rows, {TUNED: folds}, robot, 0, 1).errors(params, TUNED))


def test_copies_of_a_command_do_not_lower_the_error_of_a_model_that_memorises() -> None:
    """40 copies of each command, as in the paper's ELASTICA: ungrouped folds would report no error at all."""
    few = bending_arm(15)
    rows = replace(few, commands=np.tile(few.commands, (40, 1)), positions=np.tile(few.positions, (40, 1)))
    folds = grouped_folds(rows.commands, 3, 0)
    deep = {"n_estimators": 20, "bootstrap": False, "target_space": "cartesian"}
    assert np.mean(errors("rf", deep, rows, folds)) > 1.0


@given(st.integers(1, 5), st.integers(1, 9))
def test_a_study_sees_some_markers_the_last_and_all_that_never_move(max_markers: int, n_markers: int) -> None:
    positions = np.arange(4.0)[:, None] * np.repeat(np.r_[0.0, 1.0 + np.arange(n_markers)], 3) + 1.0
    kept = some_markers(Samples(np.zeros((4, 2)), positions), max_markers).positions
    assert kept.shape[1] == 3 + 3 * min(max_markers, n_markers)
    assert np.ptp(kept[:, :3]) == 0
    np.testing.assert_array_equal(kept[:, -3:], positions[:, -3:])
    assert (np.diff(kept[-1, ::3]) > 0).all()


def refuse(*_: object) -> None:
    raise AssertionError("it was fitted already")


def test_a_part_that_the_target_space_does_not_hold_has_an_infinite_error_and_is_the_last(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = bending_arm(40)
    behind = rows.positions.copy()
    behind[5] *= [0.0, 0.0, -1.0]
    samples = Samples(rows.commands, behind)
    parts = [(np.arange(10, 40), np.arange(10)), (np.arange(30), np.arange(30, 40)), (np.arange(10, 40), np.arange(10))]
    robot = Robot(base={"origin": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0]}, standardised_norm=False)
    curved = {"degree": 1, "target_space": "curvature"}
    found = errors("lr", curved, samples, parts, robot)
    assert len(found) == 2
    assert np.isfinite(found[0])
    assert found[1] == np.inf
    assert len(errors("lr", {"target_space": "cartesian"}, samples, parts, robot)) == 3
    held_out = HeldOut(MODELS["lr"], samples, {TUNED: parts, OUTER: parts[:1]}, robot, 0, 1)
    assert held_out.predicted(curved, TUNED) == (None, np.inf)
    assert held_out.predicted(curved, OUTER)[0] is not None
    monkeypatch.setattr("softkin.training.held_out.fitted_model", refuse)
    write_held_out(held_out, curved, tmp_path / "held_out.npz")
    assert list(read_held_out(tmp_path / "held_out.npz")) == [OUTER], "a preset without a score has no predictions"


def test_parts_are_of_the_drawn_rows_and_markers_and_only_those_that_are_scored() -> None:
    samples = bending_arm(90, n_markers=3)
    rows, parts = parts_of(samples, SETTINGS, ROBOT)
    assert rows.positions.shape == (60, 6)
    held_out = np.concatenate([scored for _, scored in parts[TUNED]])
    assert sorted(held_out) == list(range(60))
    norms = np.linalg.norm(rows.commands, axis=1)
    for core, shell in parts[OUTER]:
        assert norms[core].max() < norms[shell].min()
    assert set(parts_of(samples, replace(SETTINGS, scores=(TUNED,)), ROBOT)[1]) == {TUNED}


def test_what_is_predicted_on_the_way_is_kept_and_stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows, parts = parts_of(bending_arm(60, n_markers=2), SETTINGS, ROBOT)
    held_out = HeldOut(MODELS["lr"], rows, parts, ROBOT, 0, 1)
    by_part = {by: list(held_out.errors(LINE, by)) for by in parts}
    monkeypatch.setattr("softkin.training.held_out.fitted_model", refuse)
    write_held_out(held_out, dict(reversed(LINE.items())), tmp_path / "held_out.npz")
    stored = read_held_out(tmp_path / "held_out.npz")
    for by, of_preset in parts.items():
        truth = truth_of(rows, of_preset)
        assert stored[by].shape == (sum(map(len, truth)), 3), "the base never moves"
        split = np.split(stored[by], np.cumsum([len(part) for part in truth])[:-1])
        again = [mean_error(predicted, part) for predicted, part in zip(split, truth, strict=True)]
        assert again == by_part[by], "to the bit"
        assert held_out.predicted(LINE, by)[1] == np.mean(again)


def test_parts_are_fitted_once_with_the_same_parameters_also_after_a_trial_was_cut_short(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rows = bending_arm(60)
    folds = grouped_folds(rows.commands, 3, 0)
    held_out = HeldOut(MODELS["lr"], rows, {TUNED: folds}, ROBOT, 0, 1)
    first = next(held_out.errors(LINE, TUNED))
    assert list(held_out.errors(dict(LINE), TUNED)) == [first, *errors("lr", LINE, rows, folds)[1:]]
    predicted, score = held_out.predicted(LINE, TUNED)
    monkeypatch.setattr("softkin.training.held_out.fitted_model", refuse)
    assert np.mean(list(held_out.errors(LINE, TUNED))) == score
    np.testing.assert_array_equal(held_out.predicted(LINE, TUNED)[0], predicted)
