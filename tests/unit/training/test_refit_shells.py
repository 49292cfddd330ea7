from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from softkin.core.files import write_json
from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import read_subset, to_table, write_table
from softkin.models import MODELS
from softkin.training.refit_shells import LEAST_CORE_SHARE, ShellSettings, cores_and_shells, refit_shells
from softkin.uncertainty.calibration_data import ShellEvidence
from softkin.uncertainty.stored_outputs import StoredOutputs

RUN = ("lr", "paper")
SETTINGS = ShellSettings(core_shares=(0.5, 0.8), max_rows=1000, seed=0)


def refitted(table: Path, folder: Path, settings: ShellSettings = SETTINGS, **limits: int) -> list[ShellEvidence]:
    write_json(folder / "fit.json", {"params": {}, "skip_constant": False, "target_space": "cartesian", "base": None})
    refit_shells(
        table,
        dataset="arm",
        standardised=False,
        specs={RUN: MODELS["lr"]},
        records={RUN: folder / "fit.json"},
        max_fit_rows=limits,
        settings=settings,
        threads=1,
        shells=folder / "shells.npz",
    )
    pd.read_parquet(table).drop(columns=["u1", "u2"]).to_parquet(folder / "predictions.parquet")
    outputs = StoredOutputs(
        table,
        predictions={RUN: folder / "predictions.parquet"},
        quantiles={},
        refits=None,
        confidence_levels=[0.9],
        shells=folder / "shells.npz",
    )
    found: list[Any] = [evidence for run, evidence in outputs.of("shells") if run == RUN]
    return found


def test_each_core_is_fitted_on_its_rows_and_judged_on_its_shell(table: Path, tmp_path: Path) -> None:
    (evidence,) = refitted(table, tmp_path)
    train = read_subset(table, "train")
    sizes = [len(shell.core_commands) for shell in evidence.shells]
    assert sizes == sorted(sizes)
    assert {20, 32} <= set(sizes)
    for shell in evidence.shells:
        assert evidence.norm(shell.core_commands).max() < evidence.norm(shell.commands).min()
        core = evidence.norm(train.commands) <= evidence.norm(shell.core_commands).max()
        np.testing.assert_array_equal(shell.truth, train.positions[~core])
        design = np.column_stack([train.commands, np.ones(len(train))])
        weights = np.linalg.lstsq(design[core], train.positions[core], rcond=None)[0]
        np.testing.assert_allclose(shell.predicted, design[~core] @ weights, atol=1e-8)


def test_positions_outside_train_are_not_read(table: Path, tmp_path: Path) -> None:
    (honest,) = refitted(table, tmp_path)
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    for subset in ("validation", "test", "extrapolation"):
        subsets[subset] = Samples(subsets[subset].commands, 1e6 - subsets[subset].positions)
    write_table(to_table(subsets), tmp_path / "garbage.parquet")
    (same,) = refitted(tmp_path / "garbage.parquet", tmp_path)
    for one, other in zip(honest.shells, same.shells, strict=True):
        np.testing.assert_array_equal(one.predicted, other.predicted)


def test_the_matched_core_leaves_as_far_to_go_as_the_new_commands() -> None:
    norms = np.linspace(0.001, 1.0, 1000)
    (core, shell), *others = cores_and_shells(norms, 1.6, (0.5, 0.7))
    assert norms[core].max() == pytest.approx(0.5, abs=2e-3)
    assert {round(float(norms[core].max()), 2) for core, _ in others} == {0.62, 0.7}
    assert len(core) + len(shell) == 1000
    assert len(cores_and_shells(norms, 0.9, (0.5, 0.7))) == 2
    assert len(cores_and_shells(norms, 1.6, (0.5, 0.6))) == 2
    assert len(cores_and_shells(norms, 1.01 / LEAST_CORE_SHARE, (0.5, 0.7))) == 2


def test_a_large_core_is_fitted_on_some_of_its_rows(table: Path, tmp_path: Path) -> None:
    (all_rows,) = refitted(table, tmp_path)
    (some,) = refitted(table, tmp_path, ShellSettings((0.5, 0.8), max_rows=15, seed=0))
    (fewer,) = refitted(table, tmp_path, lr=15)
    assert not np.allclose(all_rows.shells[0].predicted, some.shells[0].predicted)
    np.testing.assert_array_equal(some.shells[0].predicted, fewer.shells[0].predicted)


def test_commands_that_lie_equally_far_out_are_left_out_by_name(
    table: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    angle = np.linspace(0, 6, len(subsets["train"]))
    circle = np.round(np.column_stack([np.cos(angle) > 0, np.cos(angle) <= 0]).astype(float), 1)
    subsets["train"] = Samples(circle, subsets["train"].positions)
    write_table(to_table(subsets), tmp_path / "circle.parquet")
    assert refitted(tmp_path / "circle.parquet", tmp_path) == []
    assert "arm is left out of the methods on shells" in caplog.text
