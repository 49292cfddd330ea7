from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import SoftkinError
from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import to_table, write_table
from softkin.models import MODELS
from softkin.training.fit import fit_quietly, kinematic_model
from softkin.uncertainty.calibrated_model import CalibratedModel, bundle
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.conftest import bending_arm

PARAMS = {"kernel": "rbf", "trend": "linear", "max_iter": 15}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("calibrated")
    subsets = {subset: bending_arm(150, n_markers=2, seed=place) for place, subset in enumerate(SUBSETS)}
    write_table(to_table(subsets), folder / "table.parquet")
    estimator = kinematic_model(MODELS["gp"], PARAMS, skip_constant=True, seed=0, threads=1)
    fit_quietly(estimator, subsets["train"], 1)
    joblib.dump(estimator, folder / "model.joblib")
    train = subsets["train"]
    norms, shells = np.linalg.norm(train.commands, axis=1), {"centre": np.zeros(2), "scale": np.ones(2)}
    for place, share in enumerate((0.5, 0.7)):
        core = norms <= np.quantile(norms, share)
        small = kinematic_model(MODELS["gp"], PARAMS, skip_constant=True, seed=0, threads=1)
        fit_quietly(small, Samples(train.commands[core], train.positions[core]), 1)
        shells |= {f"core_{place}": np.flatnonzero(core), f"shell_{place}": np.flatnonzero(~core)}
        shells[f"gp/tuned/{place}"] = small.predict(train.commands[~core])
    np.savez(folder / "shells.npz", **shells)  # type: ignore[arg-type]
    return folder


def bundled(files: Path, *methods: str, outside: str = "") -> CalibratedModel:
    """What is deployed is the first method around a model; `outside` takes over beyond the training region."""
    rows = [{"model": "gp", "preset": "tuned", "interval_method": method} for method in methods]
    around = [method for method in methods if INTERVAL_METHODS[method].on != "quantiles"]
    choice = pd.DataFrame(rows).assign(deployed=[method in around[:1] for method in methods])
    choice.assign(outside=outside or choice["interval_method"]).to_csv(files / "choice.csv", index=False)
    bundle(
        files / "table.parquet",
        dataset="arm",
        choice=files / "choice.csv",
        specs=MODELS,
        methods=INTERVAL_METHODS,
        models={("gp", "tuned"): files / "model.joblib"},
        shells=files / "shells.npz",
        output=files / "calibrated.joblib",
    )
    stored = joblib.load(files / "calibrated.joblib")
    assert isinstance(stored, CalibratedModel)
    return stored


@pytest.mark.parametrize("method", ["scp_mapie", "scp_spread", "scp_distance", "cps"])
def test_it_covers_new_rows(files: Path, method: str) -> None:
    robot, new = bundled(files, method), bending_arm(400, n_markers=2, seed=9)
    assert robot.predict(new.commands).shape == (400, 6)
    bounds = robot.intervals(new.commands, [0.8, 0.95])
    inside = (bounds[..., 0] <= new.positions) & (new.positions <= bounds[..., 1])
    assert inside[:, :, 3:].mean(axis=(1, 2)) == pytest.approx([0.8, 0.95], abs=0.06)
    assert inside[:, :, :3].all()  # the base, which never moves
    one = robot.intervals(new.commands[0], [0.8])
    np.testing.assert_allclose(one[0, 0], bounds[0, 0])


def test_one_interval_for_everywhere(files: Path) -> None:
    """Inside it is the chosen method's, outside never narrower, and wide enough where that of inside is not."""
    plain, robot = bundled(files, "scp_spread"), bundled(files, "scp_spread", outside="auto")
    far = bending_arm(400, n_markers=2, seed=9, reach=1.6)
    out = robot.is_outside(far.commands)
    assert 100 < out.sum() < 350
    assert out[np.linalg.norm(far.commands, axis=1) > np.sqrt(2)].all()
    narrow, wide = (one.intervals(far.commands, [0.8, 0.9]) for one in (plain, robot))
    np.testing.assert_array_equal(narrow[:, ~out], wide[:, ~out])
    assert (wide[..., 0] <= narrow[..., 0]).all()
    assert (wide[..., 1] >= narrow[..., 1]).all()
    covers = [
        ((b[1, ..., 0] <= far.positions) & (far.positions <= b[1, ..., 1]))[out, 3:].mean() for b in (narrow, wide)
    ]
    assert covers[1] > max(0.86, covers[0] + 0.03)
    np.testing.assert_array_equal(plain.is_outside(bending_arm(50, seed=3).commands * 0.3), False)


def test_false_alarms_are_rare_and_a_robot_elsewhere_is_noticed(files: Path) -> None:
    robot, new = bundled(files, "scp_mapie"), bending_arm(400, n_markers=2, seed=9)
    single, joint = robot.p_values(new.commands, new.positions)
    assert single.shape == (400, 6)
    assert (joint <= 0.1).mean() == pytest.approx(0.1, abs=0.06)
    assert (single[:, 3:] <= 0.1).mean() == pytest.approx(0.1, abs=0.06)
    moved = new.positions + np.array([0, 0, 0, 2.0, 0, 0])
    assert (robot.p_values(new.commands, moved)[1] <= 0.1).mean() > 0.95
    smooth = robot.p_values(new.commands, new.positions, rng=np.random.default_rng(0))[1]
    assert ((smooth <= joint) & (joint - smooth <= 1 / 151 + 1e-12)).all()


def test_the_box_holds_the_whole_robot_and_says_what_the_p_value_says(files: Path) -> None:
    robot, new = bundled(files, "scp_mapie"), bending_arm(400, n_markers=2, seed=9)
    half = robot.box(0.9)
    assert (half[:3] == 0).all()
    inside = (np.abs(new.positions - robot.predict(new.commands))[:, 3:] <= half[3:]).all(axis=1)
    assert inside.mean() == pytest.approx(0.9, abs=0.06)
    np.testing.assert_array_equal(inside, robot.p_values(new.commands, new.positions)[1] > 0.1)


def test_a_learner_of_quantiles_gives_way_to_the_next_best(files: Path) -> None:
    assert bundled(files, "cqr", "scp_crepes").method.name == "scp_crepes"
    with pytest.raises(SoftkinError, match="add scp_mapie"):
        bundled(files, "cqr")


@pytest.mark.parametrize("method", ["scp_mapie", "scp_spread"])
def test_what_never_changes_is_worked_out_once(files: Path, method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    robot, asked = bundled(files, method), []
    predict = type(robot.estimator).predict
    monkeypatch.setattr(
        type(robot.estimator), "predict", lambda self, rows: [asked.append(len(rows)), predict(self, rows)][1]
    )
    new = bending_arm(7, n_markers=2, seed=9)
    robot.intervals(new.commands, [0.9])
    robot.box(0.9)
    robot.p_values(new.commands, new.positions)
    assert asked == [7, 7]


def test_wrong_commands_are_refused(files: Path) -> None:
    robot = bundled(files, "scp_mapie")
    for wrong in (np.zeros((4, 3)), np.full((1, 2), np.nan)):
        with pytest.raises(SoftkinError, match=r"arm: expected finite commands of shape \(n_rows, 2\)"):
            robot.predict(wrong)
    with pytest.raises(ValueError, match="inhomogeneous"):
        robot.predict([[1.0], [1.0, 2.0]])  # type: ignore[arg-type]
    known = robot.known
    few = replace(robot, known=replace(known, calibration=known.calibration[:5], truth=known.truth[:5]))
    assert np.isinf(few.intervals(np.zeros(2), [0.9])).all()
