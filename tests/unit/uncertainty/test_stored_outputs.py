from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from softkin.core.files import write_json
from softkin.core.manifest import MANIFEST, write_manifest
from softkin.core.run_archive import RunArchive
from softkin.core.runs import INTERPOLATION, TUNED, Run
from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import read_subset
from softkin.training.held_out import PartSettings, Robot, parts_of, truth_of
from softkin.uncertainty.calibration_data import (
    CalibrationData,
    FoldCalibration,
    HeldOutCalibration,
    PointCalibration,
    PredictiveCalibration,
    QuantileCalibration,
    ResampleCalibration,
    ShellCalibration,
    SpreadCalibration,
)
from softkin.uncertainty.stored_outputs import StoredOutputs, norm_of, shells_of, stored_outputs
from tests.unit.uncertainty.conftest import (
    RUN,
    STORED_LEVELS,
    garbled,
    refits_of,
    stored_outputs_of,
)

COORDINATES = ["m1_x", "m1_y", "m1_z"]
KINDS: list[type[CalibrationData]] = [
    *(PointCalibration, SpreadCalibration, PredictiveCalibration, QuantileCalibration),
    *(FoldCalibration, ResampleCalibration, ShellCalibration),
]


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_read_for_the_run_that_has_it(table: Path, stored: Path, kind: type[CalibrationData]) -> None:
    ((run, data),) = stored_outputs_of(table, stored).of(kind)
    assert run == RUN
    assert isinstance(data, kind)


def test_points_are_those_of_their_subsets(table: Path, stored: Path) -> None:
    subsets = {subset: read_subset(table, subset) for subset in SUBSETS}
    ((_, data),) = stored_outputs_of(table, stored).of(PredictiveCalibration)
    new = [subsets[subset] for subset in ("test", "extrapolation")]
    np.testing.assert_array_equal(data.truth, subsets["validation"].positions)
    off_mm = np.array([1.0, 0.0, 0.0])
    np.testing.assert_allclose(data.calibration, subsets["validation"].positions + off_mm)
    np.testing.assert_allclose(data.new, np.concatenate([rows.positions for rows in new]) + off_mm)
    np.testing.assert_array_equal(data.train_commands, subsets["train"].commands)
    np.testing.assert_array_equal(data.calibration_commands, subsets["validation"].commands)
    np.testing.assert_array_equal(data.new_commands, np.concatenate([rows.commands for rows in new]))
    shapes = [spread.shape for spread in (data.train_spread, data.calibration_spread, data.new_spread)]
    assert shapes == [(40, 3), (40, 3), (80, 3)]
    assert set(data.new_spread.ravel()) == {2.0}


def test_of_train_the_rows_with_a_spread_are_read(table: Path, stored: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("softkin.training.predict.SPREAD_ROWS", 7)
    ((_, data),) = stored_outputs_of(table, stored).of(SpreadCalibration)
    assert data.train_spread.shape == (7, 3)
    assert data.calibration_spread.shape == (40, 3)


def test_a_spread_that_is_no_standard_deviation_is_not_predictive(table: Path, stored: Path) -> None:
    predictions = pd.read_parquet(stored / "predictions.parquet")
    predictions.rename(columns=lambda name: name.replace("std_", "spread_")).to_parquet(stored / "predictions.parquet")
    outputs = stored_outputs_of(table, stored)
    assert [run for run, _ in outputs.of(SpreadCalibration)] == [RUN]
    assert not list(outputs.of(PredictiveCalibration))
    assert [run for run, _ in outputs.of(PointCalibration)] == [RUN]


def test_quantiles_have_a_pair_for_each_level(table: Path, stored: Path) -> None:
    ((_, data),) = stored_outputs_of(table, stored).of(QuantileCalibration)
    assert data.calibration.shape == (2, 40, 3, 2)
    assert data.new.shape == (2, 80, 3, 2)
    np.testing.assert_allclose(data.calibration.mean(axis=-1)[0], data.truth)


def test_each_row_of_train_is_held_out_by_one_fold_and_by_some_sample(table: Path, stored: Path) -> None:
    outputs, archive = stored_outputs_of(table, stored), refits_of(table)
    ((_, folds),), ((_, samples),) = outputs.of(FoldCalibration), outputs.of(ResampleCalibration)
    held_out = [np.setdiff1d(np.arange(40), rows) for rows in folds.fitted_rows]
    assert sorted(np.concatenate(held_out)) == list(range(40))
    np.testing.assert_array_equal(samples.fitted_rows, archive.shared["resample_rows"])
    for data, part in ((folds, "folds"), (samples, "resamples")):
        predicted = archive.of_runs[RUN, part]
        np.testing.assert_array_equal(data.train, predicted[:, :40])
        np.testing.assert_array_equal(data.new, predicted[:, 40:])
        np.testing.assert_array_equal(data.truth, read_subset(table, "train").positions)


def test_shells_come_with_their_cores_the_smallest_first(table: Path, stored: Path) -> None:
    ((_, data),) = stored_outputs_of(table, stored).of(ShellCalibration)
    train = read_subset(table, "train")
    radii = [data.norm(shell.core_commands).max() for shell in data.shells]
    assert radii == sorted(radii)
    for shell, radius in zip(data.shells, radii, strict=True):
        np.testing.assert_array_equal(shell.truth, train.positions[data.norm(train.commands) > radius])
        assert (np.abs(shell.predicted - shell.truth) >= 1).all()
    ((_, points),) = stored_outputs_of(table, stored).of(PointCalibration)
    np.testing.assert_array_equal(data.deployed.new, points.new)


def test_without_files_there_is_nothing_of_a_kind(table: Path) -> None:
    outputs = StoredOutputs(table, predictions={}, quantiles={}, refits=None, confidence_levels=STORED_LEVELS)
    assert [list(outputs.of(kind)) for kind in KINDS] == [[]] * len(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_true_positions_are_read_of_train_and_validation_only(
    table: Path, stored: Path, kind: type[CalibrationData]
) -> None:
    same = garbled(table, ("test", "extrapolation"), stored / "garbage.parquet")
    honest, spared = (next(stored_outputs_of(path, stored).of(kind))[1] for path in (table, same))
    if isinstance(honest, ShellCalibration):
        assert isinstance(spared, ShellCalibration)
        honest, spared = honest.deployed, spared.deployed
    for one, other in zip(vars(honest).values(), vars(spared).values(), strict=True):
        np.testing.assert_array_equal(one, other)


def test_new_rows_are_split_into_their_subsets(table: Path) -> None:
    outputs = StoredOutputs(table, predictions={}, quantiles={}, refits=None, confidence_levels=STORED_LEVELS)
    rows = np.arange(160.0).reshape(2, 80)
    parts = outputs.by_subset(rows, axis=1)
    assert list(parts) == ["test", "extrapolation"]
    np.testing.assert_array_equal(np.concatenate(list(parts.values()), axis=1), rows)
    assert parts["test"].shape == (2, 40)


def manifest_of(run: Run, file: Path, folder: Path) -> Path:
    """The manifest of a model whose run has this file alone."""
    place = folder / run.model / run.preset / file.name
    place.parent.mkdir(parents=True)
    shutil.copy(file, place)
    write_manifest(folder / run.model / MANIFEST, [place])
    return folder / run.model / MANIFEST


def test_a_rule_names_its_stored_outputs(table: Path, stored: Path, tmp_path: Path) -> None:
    regressor = Run("gb", "paper")
    files = {
        "models": [manifest_of(RUN, stored / "predictions.parquet", tmp_path / "models")],
        "quantile_models": [manifest_of(regressor, stored / "quantiles.parquet", tmp_path / "quantiles")],
    }
    files |= {name: [stored / f"{name}.npz"] for name in ("refits", "shells")}
    params = SimpleNamespace(
        runs=[[*RUN]], quantile_runs=[[*regressor]], confidence_levels=STORED_LEVELS, study_parts=None
    )
    outputs = stored_outputs(SimpleNamespace(table=table, **files), params)
    assert [run for run, _ in outputs.of(PointCalibration)] == [RUN]
    assert [run for run, _ in outputs.of(QuantileCalibration)] == [regressor]
    assert all(list(outputs.of(kind)) for kind in (FoldCalibration, ShellCalibration))
    few = stored_outputs(SimpleNamespace(table=table, **files | {"refits": [], "shells": []}), params)
    assert not any(list(few.of(kind)) for kind in (FoldCalibration, ShellCalibration))


def test_a_rule_that_asks_for_difficulties_has_those_of_searched_runs(
    table: Path, stored: Path, tmp_path: Path
) -> None:
    run, parts = Run("mlp", "tuned"), {"n_folds": 4, "max_rows": 30, "max_markers": 2}
    settings = PartSettings(**parts, core_shares=(), scores={TUNED}, seed=0)
    rows, folds = parts_of(read_subset(table, "train"), settings, Robot(None, False))
    folder = tmp_path / "models" / "mlp" / "tuned"
    folder.mkdir(parents=True)
    shutil.copy(stored / "predictions.parquet", folder)
    truth = np.concatenate(truth_of(rows, folds[TUNED]))
    np.savez(folder / "held_out.npz", **{TUNED: truth + 1})  # type: ignore[arg-type]
    write_json(folder / "fit.json", {})
    write_json(folder / "parameters.json", {"cv_mae_mm": 1.0, "target_space": "cartesian"})
    write_manifest(folder.parent / MANIFEST, sorted(folder.iterdir()))
    files = {"models": [folder.parent / MANIFEST], "quantile_models": [], "refits": [], "shells": []}
    of_rule = {
        "runs": [[*run]],
        "quantile_runs": [],
        "searched": [[*run]],
        "pool": [[*run]],
        "seed": 0,
        "objective": INTERPOLATION,
    }
    params = SimpleNamespace(**of_rule, study_parts=parts, confidence_levels=STORED_LEVELS)
    outputs = stored_outputs(SimpleNamespace(table=table, **files), params)
    ((found, data),) = outputs.of(HeldOutCalibration)
    assert found == run
    assert len(data.difficulty.points) == len(truth)
    assert not list(
        StoredOutputs(table, predictions={}, quantiles={}, refits=None, confidence_levels=STORED_LEVELS).of(
            HeldOutCalibration
        )
    )


def test_an_archive_gives_shells_by_run_and_the_command_norm() -> None:
    train = Samples(np.array([[1.0], [2.0], [4.0]]), np.arange(9.0).reshape(3, 3))
    shared = {"core_0": np.array([0]), "shell_0": np.array([1, 2]), "centre": np.array([1.0]), "scale": np.array([2.0])}
    archive = RunArchive(shared, {(RUN, "0"): np.zeros((2, 3)), (Run("gp", "tuned"), "0"): np.ones((2, 3))})
    shells = shells_of(archive, train)
    assert list(shells) == [RUN, Run("gp", "tuned")]
    assert shells[RUN][0].core_commands.tolist() == [[1.0]]
    assert shells[RUN][0].commands.tolist() == [[2.0], [4.0]]
    np.testing.assert_array_equal(shells[RUN][0].truth, train.positions[1:])
    assert norm_of(archive)(train.commands).tolist() == [0.0, 0.5, 1.5]
    assert len(shells_of(shells_of_none(), train)) == 0


def shells_of_none() -> RunArchive:
    return RunArchive({"centre": np.zeros(1)}, {})


def test_where_blocks_are_exchangeable_each_counts_alike(table: Path, stored: Path, tmp_path: Path) -> None:
    frame = pd.read_parquet(table)
    n_validation = int((frame["subset"] == "validation").sum())
    frame["block"] = 0
    frame.loc[frame["subset"] == "validation", "block"] = np.minimum(np.arange(n_validation), 9)
    frame.attrs = {}
    frame.to_parquet(tmp_path / "blocks.parquet")
    outputs = stored_outputs_of(tmp_path / "blocks.parquet", stored)
    assert outputs.promise is not None
    assert outputs.promise.n_blocks == 10
    assert len(outputs.validation) == len(outputs.calibrated) == 10 * (n_validation - 9)
    assert (np.bincount(outputs.calibrated)[:9] == n_validation - 9).all()
    by_row = dict(stored_outputs_of(table, stored).of(PointCalibration))
    for run, data in outputs.of(PointCalibration):
        np.testing.assert_array_equal(data.calibration, by_row[run].calibration[outputs.calibrated])
        np.testing.assert_array_equal(data.truth, by_row[run].truth[outputs.calibrated])
    for _, quantiles in outputs.of(QuantileCalibration):
        assert quantiles.calibration.shape[1] == len(quantiles.truth) == len(outputs.validation)
