from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from softkin.core.errors import ConfigError
from softkin.core.files import write_json
from softkin.core.run_archive import CPU_SECONDS, RunArchive, read_run_archive
from softkin.core.runs import Run
from softkin.core.samples import Array
from softkin.data.table import read_subset
from softkin.models import MODELS
from softkin.training.refit import (
    FOLD_OF_ROW,
    FOLDS,
    RESAMPLE_ROWS,
    RESAMPLES,
    RefittingSettings,
    drawn_resamples,
    refit,
)

SETTINGS = RefittingSettings(n_folds=4, n_resamples=12, max_train_rows=2000, seed=0)
RUN = Run("lr", "paper")


def refitted(table: Path, folder: Path, settings: RefittingSettings = SETTINGS) -> RunArchive:
    static = {"params": {}, "skip_constant": False, "target_space": "cartesian", "base": None, "memory": None}
    write_json(folder / "fit.json", static)
    refit(
        table,
        dataset="arm",
        specs={RUN: MODELS["lr"]},
        records={RUN: folder / "fit.json"},
        settings=settings,
        threads=1,
        refits=folder / "refits.npz",
    )
    return read_run_archive(folder / "refits.npz")


def fitted_rows(archive: RunArchive) -> dict[str, list[Array]]:
    """The rows of train that each refit was fitted on, by part."""
    fold_of_row = archive.shared[FOLD_OF_ROW]
    folds = [np.flatnonzero(fold_of_row != fold) for fold in range(SETTINGS.n_folds)]
    return {FOLDS: folds, RESAMPLES: list(archive.shared[RESAMPLE_ROWS])}


def test_each_refit_is_the_model_on_its_rows(table: Path, tmp_path: Path) -> None:
    train, *others = (read_subset(table, subset) for subset in ("train", "test", "extrapolation"))
    commands = np.concatenate([train.commands, *(rows.commands for rows in others)])
    archive = refitted(table, tmp_path)
    assert archive.of_runs.keys() == {(RUN, FOLDS), (RUN, RESAMPLES)}
    for part, rows_of_fits in fitted_rows(archive).items():
        for rows, predicted in zip(rows_of_fits, archive.of_runs[RUN, part], strict=True):
            design = np.column_stack([train.commands, np.ones(len(train))])
            weights = np.linalg.lstsq(design[rows], train.positions[rows], rcond=None)[0]
            expected = np.column_stack([commands, np.ones(len(commands))]) @ weights
            np.testing.assert_allclose(predicted, expected, atol=1e-8)


def test_an_ensemble_is_the_weighted_mean_of_the_refits_of_its_members(table: Path, tmp_path: Path) -> None:
    alone = refitted(table, tmp_path)
    static = {"params": {"degree": 2}, "skip_constant": False, "target_space": "cartesian", "base": None}
    write_json(tmp_path / "square.json", static | {"memory": None})
    square, mean = Run("lr", "outer"), Run("ensemble", "outer")
    refit(
        table,
        dataset="arm",
        specs=dict.fromkeys((RUN, square), MODELS["lr"]),
        records={RUN: tmp_path / "fit.json", square: tmp_path / "square.json"},
        settings=SETTINGS,
        threads=1,
        refits=tmp_path / "refits.npz",
        weights={mean: {RUN: 0.25, square: 0.75}, square: {square: 1.0}},
    )
    archive = read_run_archive(tmp_path / "refits.npz")
    assert {run for run, _ in archive.of_runs} == {mean, square}, "a member that nobody asked for is not written"
    for part in (FOLDS, RESAMPLES):
        expected = 0.25 * alone.of_runs[RUN, part] + 0.75 * archive.of_runs[square, part]
        np.testing.assert_allclose(archive.of_runs[mean, part], expected, atol=1e-9)


def test_every_row_is_held_out_of_one_fold_and_of_some_sample(table: Path, tmp_path: Path) -> None:
    rows = fitted_rows(refitted(table, tmp_path))
    n = len(read_subset(table, "train"))
    left_out = {part: [np.setdiff1d(np.arange(n), fit) for fit in fits] for part, fits in rows.items()}
    assert sorted(np.concatenate(left_out[FOLDS])) == list(range(n))
    assert not set(range(n)) - set(np.concatenate(left_out[RESAMPLES]))
    assert [len(fit) for fit in rows[RESAMPLES]] == [n] * SETTINGS.n_resamples


def test_the_cpu_time_of_all_fits_is_kept(table: Path, tmp_path: Path) -> None:
    assert refitted(table, tmp_path).shared[CPU_SECONDS] > 0


def test_a_large_dataset_is_left_out_by_name(table: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO", logger="softkin")
    archive = refitted(table, tmp_path, replace(SETTINGS, max_train_rows=39))
    assert archive.of_runs == {}
    assert archive.shared == {CPU_SECONDS: 0.0}
    assert "arm is left out of the methods that refit: 40 rows of train, refitting.max_train_rows is 39" in caplog.text


def test_too_few_bootstrap_samples_are_an_error_with_its_fix() -> None:
    assert len(drawn_resamples(200, replace(SETTINGS, n_resamples=20))) == 20
    with pytest.raises(ConfigError, match=r"fix: raise refitting.n_resamples") as caught:
        drawn_resamples(2000, replace(SETTINGS, n_resamples=2))
    assert caught.value.where == "refitting.n_resamples"
