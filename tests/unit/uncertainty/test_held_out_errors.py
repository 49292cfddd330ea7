"""Difficulties of searched runs, by what their studies stored."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from softkin.core.files import write_json
from softkin.core.runs import TUNED, Run
from softkin.training.held_out import PartSettings, Robot, parts_of, truth_of
from softkin.uncertainty.held_out_errors import difficulties
from tests.conftest import bending_arm

SETTINGS = PartSettings(4, (), max_rows=200, max_markers=1, scores={TUNED}, seed=0)
TRAIN = bending_arm(240, n_markers=3)
ROWS, PARTS = parts_of(TRAIN, SETTINGS, Robot(None, False))
TRUTH = np.concatenate(truth_of(ROWS, PARTS[TUNED]))
SCORED = ROWS.commands[np.concatenate([scored for _, scored in PARTS[TUNED]])]
ONE, OTHER, MEAN, LOST = (Run(name, "tuned") for name in ("ridge", "huber", "ensemble", "gp"))


@pytest.fixture
def files(tmp_path: Path) -> tuple[dict[Run, Path], dict[Run, Path]]:
    """What is held out, and records: `ridge` errs with the first command, `huber` by the opposite; `gp` has none."""
    errors = np.exp(1.5 * SCORED[:, :1] / SCORED[:, 0].std()) * np.random.default_rng(0).standard_normal(TRUTH.shape)
    held_out = {run: tmp_path / f"{run.model}.npz" for run in (ONE, OTHER, LOST)}
    np.savez(held_out[ONE], **{TUNED: TRUTH + errors})
    np.savez(held_out[OTHER], **{TUNED: TRUTH - errors + 0.1})
    np.savez(held_out[LOST], outer=TRUTH)
    records = {run: tmp_path / f"{run.model}.json" for run in (ONE, OTHER, MEAN, LOST)}
    members = [{"model": run.model, "preset": run.preset, "weight": 0.5} for run in (ONE, OTHER)]
    for run, path in records.items():
        write_json(path, {"members": members} if run == MEAN else {})
    return held_out, records


def test_errors_are_those_of_the_rows_that_were_held_out(files: tuple[dict[Run, Path], dict[Run, Path]]) -> None:
    found = difficulties(TRAIN, SETTINGS, *files)
    assert list(found) == [ONE, OTHER, MEAN]
    hard = found[ONE]
    np.testing.assert_allclose(hard.points * hard.scale + hard.mean, SCORED)
    far = SCORED[:, 0].std()
    low, high = hard.of(np.array([[-far, 0.0], [far, 0.0]]))[:, -3:]
    assert (high > 2 * low).all()


def test_an_ensemble_errs_as_the_mean_of_its_members(files: tuple[dict[Run, Path], dict[Run, Path]]) -> None:
    """Here by 0.05 mm everywhere."""
    mean = difficulties(TRAIN, SETTINGS, *files)[MEAN]
    np.testing.assert_allclose(mean.errors, 1.0)
    np.testing.assert_array_equal(mean.shares, 0.0)


def test_markers_that_were_not_scored_have_the_mean_of_those_that_were(
    files: tuple[dict[Run, Path], dict[Run, Path]],
) -> None:
    n_scored, column = TRUTH.shape[1], difficulties(TRAIN, SETTINGS, *files)[ONE].column
    np.testing.assert_array_equal(column[-n_scored:], np.arange(n_scored))
    np.testing.assert_array_equal(column[:-n_scored], [-1, -1, -1, *[n_scored] * 3])
