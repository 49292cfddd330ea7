from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from softkin.core.files import write_json
from softkin.core.run_archive import CPU_SECONDS, RunArchive, read_run_archive
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, Array, Samples
from softkin.core.shells import CommandNorm
from softkin.data.table import read_subset, to_table, write_table
from softkin.models import MODELS
from softkin.training.refit_shells import (
    CENTRE,
    LEAST_CORE_SHARE,
    SCALE,
    ShellSettings,
    core_rows,
    cores_and_shells,
    refit_shells,
    shell_rows,
)

RUN = Run("lr", "paper")
SETTINGS = ShellSettings(core_shares=(0.5, 0.8), max_rows=1000, standardised_norm=False, seed=0, threads=1)


def refitted(table: Path, folder: Path, settings: ShellSettings = SETTINGS, **max_fit_rows: int) -> RunArchive:
    static = {"params": {}, "skip_constant": False, "target_space": "cartesian", "base": None, "memory": None}
    write_json(folder / "fit.json", static)
    refit_shells(
        table,
        dataset="arm",
        specs={RUN: MODELS["lr"]},
        records={RUN: folder / "fit.json"},
        max_fit_rows=max_fit_rows,
        settings=settings,
        shells=folder / "shells.npz",
    )
    return read_run_archive(folder / "shells.npz")


def shells_of(archive: RunArchive) -> list[tuple[NDArray[np.intp], NDArray[np.intp], Array]]:
    """Rows of the core, rows of the shell and predicted positions of each shell, in the order of the archive."""
    places = [place for run, place in archive.of_runs if run == RUN]
    return [
        (archive.shared[core_rows(place)], archive.shared[shell_rows(place)], archive.of_runs[RUN, place])
        for place in places
    ]


def test_each_core_is_fitted_on_its_rows_and_judged_on_its_shell(table: Path, tmp_path: Path) -> None:
    archive = refitted(table, tmp_path)
    train = read_subset(table, "train")
    norms = CommandNorm(archive.shared[CENTRE], archive.shared[SCALE]).of(train.commands)
    np.testing.assert_allclose(norms, np.linalg.norm(train.commands, axis=1))
    sizes = [len(core) for core, _, _ in shells_of(archive)]
    assert sizes == sorted(sizes)
    assert {20, 32} <= set(sizes)
    for core, shell, predicted in shells_of(archive):
        assert norms[core].max() < norms[shell].min()
        in_core = norms <= norms[core].max()
        np.testing.assert_array_equal(shell, np.flatnonzero(~in_core))
        design = np.column_stack([train.commands, np.ones(len(train))])
        weights = np.linalg.lstsq(design[in_core], train.positions[in_core], rcond=None)[0]
        np.testing.assert_allclose(predicted, design[~in_core] @ weights, atol=1e-8)
    assert archive.shared[CPU_SECONDS] > 0


def test_an_ensemble_is_the_weighted_mean_of_its_members_on_each_shell(table: Path, tmp_path: Path) -> None:
    alone, mean = refitted(table, tmp_path), Run("ensemble", "outer")
    refit_shells(
        table,
        dataset="arm",
        specs={RUN: MODELS["lr"]},
        records={RUN: tmp_path / "fit.json"},
        max_fit_rows={},
        settings=SETTINGS,
        shells=tmp_path / "shells.npz",
        weights={mean: {RUN: 1.0}},
    )
    archive = read_run_archive(tmp_path / "shells.npz")
    assert archive.of_runs.keys() == {(mean, place) for _, place in alone.of_runs}
    for (_, place), predicted in archive.of_runs.items():
        np.testing.assert_array_equal(predicted, alone.of_runs[RUN, place])


def test_the_norm_is_that_of_standardised_commands_where_the_dataset_has_that(table: Path, tmp_path: Path) -> None:
    archive = refitted(table, tmp_path, replace(SETTINGS, standardised_norm=True))
    commands = read_subset(table, "train").commands
    np.testing.assert_array_equal(archive.shared[CENTRE], commands.mean(axis=0))
    np.testing.assert_array_equal(archive.shared[SCALE], commands.std(axis=0))


def test_positions_of_other_subsets_are_not_read(table: Path, garbage_table: Path, tmp_path: Path) -> None:
    honest, same = (shells_of(refitted(path, tmp_path)) for path in (table, garbage_table))
    assert honest
    for one, other in zip(honest, same, strict=True):
        np.testing.assert_array_equal(one[2], other[2])


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
    first = [
        shells_of(archive)[0][2]
        for archive in (
            refitted(table, tmp_path),
            refitted(table, tmp_path, replace(SETTINGS, max_rows=15)),
            refitted(table, tmp_path, lr=15),
        )
    ]
    assert not np.allclose(first[0], first[1])
    np.testing.assert_array_equal(first[1], first[2])


def test_commands_that_lie_equally_far_out_are_left_out_by_name(
    table: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    angle = np.linspace(0, 6, len(subsets["train"]))
    circle = np.round(np.column_stack([np.cos(angle) > 0, np.cos(angle) <= 0]).astype(float), 1)
    subsets["train"] = Samples(circle, subsets["train"].positions)
    write_table(to_table(subsets), tmp_path / "circle.parquet")
    assert refitted(tmp_path / "circle.parquet", tmp_path).of_runs == {}
    assert "arm is left out of the methods on shells" in caplog.text
