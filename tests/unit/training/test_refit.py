from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from softkin.core.errors import SoftkinError
from softkin.core.files import write_json
from softkin.data.table import read_subset
from softkin.models import MODELS
from softkin.training.refit import RefittingSettings, drawn_resamples, refit
from softkin.uncertainty.calibration_data import RefitEvidence
from softkin.uncertainty.stored_outputs import StoredOutputs

SETTINGS = RefittingSettings(n_folds=4, n_resamples=12, max_train_rows=2000, seed=0)
RUN = ("lr", "paper")


def refitted(table: Path, folder: Path, settings: RefittingSettings = SETTINGS) -> dict[str, list[RefitEvidence]]:
    write_json(folder / "fit.json", {"params": {}, "skip_constant": False, "target_space": "cartesian", "base": None})
    refit(
        table,
        dataset="arm",
        specs={RUN: MODELS["lr"]},
        records={RUN: folder / "fit.json"},
        settings=settings,
        threads=1,
        refits=folder / "refits.npz",
    )
    outputs = StoredOutputs(table, predictions={}, quantiles={}, refits=folder / "refits.npz", confidence_levels=[0.9])
    found: dict[str, list[RefitEvidence]] = {}
    for kind in ("folds", "resamples"):
        found[kind] = [evidence for run, evidence in outputs.of(kind) if run == RUN]  # type: ignore[misc]
    return found


def test_each_refit_is_the_model_on_its_rows(table: Path, tmp_path: Path) -> None:
    train, test = read_subset(table, "train"), read_subset(table, "test")
    for outputs in refitted(table, tmp_path).values():
        (evidence,) = outputs
        for inside, on_train, on_new in zip(evidence.inside, evidence.train, evidence.new, strict=True):
            design = np.column_stack([train.commands, np.ones(len(train))])
            weights = np.linalg.lstsq(design[inside], train.positions[inside], rcond=None)[0]
            np.testing.assert_allclose(on_train, design @ weights, atol=1e-8)
            expected = np.column_stack([test.commands, np.ones(len(test))]) @ weights
            np.testing.assert_allclose(on_new[: len(test)], expected, atol=1e-8)
        np.testing.assert_array_equal(evidence.truth, train.positions)


def test_every_row_is_held_out_of_one_fold_and_of_some_sample(table: Path, tmp_path: Path) -> None:
    found = refitted(table, tmp_path)
    n = len(read_subset(table, "train"))
    left_out = [np.setdiff1d(np.arange(n), inside) for inside in found["folds"][0].inside]
    assert sorted(np.concatenate(left_out)) == list(range(n))
    assert not set(range(n)) - set(
        np.concatenate([np.setdiff1d(np.arange(n), i) for i in found["resamples"][0].inside])
    )


def test_a_large_dataset_is_left_out_by_name(table: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO", logger="softkin")
    found = refitted(table, tmp_path, replace(SETTINGS, max_train_rows=39))
    assert found == {"folds": [], "resamples": []}
    assert "arm is left out of the methods that refit: 40 rows of train, refitting.max_train_rows is 39" in caplog.text


def test_too_few_bootstrap_samples_are_an_error_with_its_mend() -> None:
    assert len(drawn_resamples(200, replace(SETTINGS, n_resamples=20))) == 20
    with pytest.raises(SoftkinError, match=r"mend: raise refitting.n_resamples"):
        drawn_resamples(2000, replace(SETTINGS, n_resamples=2))
