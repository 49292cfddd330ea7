from __future__ import annotations

from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.core.errors import ConfigError
from softkin.core.files import write_json
from softkin.core.job_records import record_job
from softkin.core.run_archive import RunArchive
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS, Array, Samples
from softkin.data.table import to_table, write_table
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.build_calibrated_model import build_calibrated_model
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.prepared import Prepared
from softkin.uncertainty.stored_outputs import StoredOutputs
from tests.conftest import bending_arm

RUN = Run("gp", "tuned")
SETTINGS = FitSettings({"kernel": "rbf", "trend": "linear", "max_iter": 15}, skip_constant=True, seed=0, threads=1)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("calibrated")
    subsets = {subset: bending_arm(150, n_markers=2, seed=place) for place, subset in enumerate(SUBSETS)}
    write_table(to_table(subsets), folder / "table.parquet")
    write_json(folder / "dataset.json", {"dataset": "arm"})
    train = subsets["train"]
    joblib.dump(fitted_model(MODELS["gp"], SETTINGS, train), folder / "model.joblib")
    record_job(folder / "logs" / "fit_model.log", [folder / "model.joblib"])
    norms = np.linalg.norm(train.commands, axis=1)
    shared: dict[str, Any] = {"centre": np.zeros(2), "scale": np.ones(2)}
    of_runs = {}
    for place, share in enumerate((0.5, 0.7)):
        core = norms <= np.quantile(norms, share)
        small = fitted_model(MODELS["gp"], SETTINGS, Samples(train.commands[core], train.positions[core]))
        shared |= {f"core_{place}": np.flatnonzero(core), f"shell_{place}": np.flatnonzero(~core)}
        of_runs[RUN, str(place)] = small.predict(train.commands[~core])
    RunArchive(shared, of_runs).write(folder / "shells.npz")
    return folder


def built(files: Path, *methods: str, in_extrapolation: str = "") -> CalibratedModel:
    """What is deployed is the first method around a model; `in_extrapolation` replaces it there."""
    rows = [{**RUN._asdict(), "interval_method": method} for method in methods]
    around = [method for method in methods if INTERVAL_METHODS[method].calibrated_on.is_around_a_model]
    choice = pd.DataFrame(rows).assign(deployed=[method in around[:1] for method in methods])
    choice.assign(outside=in_extrapolation or choice["interval_method"]).to_csv(files / "choice.csv", index=False)
    build_calibrated_model(
        StoredOutputs(
            files / "table.parquet",
            predictions={},
            quantiles={},
            refits=None,
            confidence_levels=[0.9],
            shells=files / "shells.npz",
        ),
        description=files / "dataset.json",
        choice=files / "choice.csv",
        specs=MODELS,
        methods=INTERVAL_METHODS,
        models={RUN: files / "model.joblib"},
        output=files / "calibrated.joblib",
    )
    stored = joblib.load(files / "calibrated.joblib")
    assert isinstance(stored, CalibratedModel)
    return stored


@pytest.mark.parametrize("method", ["scp_mapie", "scp_spread", "scp_distance", "cps"])
def test_it_covers_new_rows(files: Path, method: str) -> None:
    robot, new = built(files, method), bending_arm(400, n_markers=2, seed=9)
    assert robot.predict(new.commands).shape == (400, 6)
    bounds = robot.intervals(new.commands, [0.8, 0.95])
    covers = (bounds[..., 0] <= new.positions) & (new.positions <= bounds[..., 1])
    assert covers[:, :, 3:].mean(axis=(1, 2)) == pytest.approx([0.8, 0.95], abs=0.06)
    assert covers[:, :, :3].all()  # the base, which never moves
    one = robot.intervals(new.commands[0], [0.8])
    np.testing.assert_allclose(one[0, 0], bounds[0, 0])


def test_in_extrapolation_intervals_are_made_from_shells(files: Path) -> None:
    """In-domain they are the chosen method's; in extrapolation never narrower, and wide enough where that is not."""
    plain, robot = built(files, "scp_spread"), built(files, "scp_spread", in_extrapolation="auto")
    far = bending_arm(400, n_markers=2, seed=9, largest_command=1.6)
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
    robot, new = built(files, "scp_mapie"), bending_arm(400, n_markers=2, seed=9)
    single, joint = robot.p_values(new.commands, new.positions)
    assert single.shape == (400, 6)
    assert (joint <= 0.1).mean() == pytest.approx(0.1, abs=0.06)
    assert (single[:, 3:] <= 0.1).mean() == pytest.approx(0.1, abs=0.06)
    moved = new.positions + np.array([0, 0, 0, 2.0, 0, 0])
    assert (robot.p_values(new.commands, moved)[1] <= 0.1).mean() > 0.95
    smooth = robot.p_values(new.commands, new.positions, rng=np.random.default_rng(0))[1]
    assert ((smooth <= joint) & (joint - smooth <= 1 / 151 + 1e-12)).all()


def test_the_box_holds_the_whole_robot_and_says_what_the_p_value_says(files: Path) -> None:
    robot, new = built(files, "scp_mapie"), bending_arm(400, n_markers=2, seed=9)
    half = robot.box(0.9)
    assert (half[:3] == 0).all()
    covers = (np.abs(new.positions - robot.predict(new.commands))[:, 3:] <= half[3:]).all(axis=1)
    assert covers.mean() == pytest.approx(0.9, abs=0.06)
    np.testing.assert_array_equal(covers, robot.p_values(new.commands, new.positions)[1] > 0.1)


def test_a_quantile_regressor_gives_way_to_the_next_best(files: Path) -> None:
    assert built(files, "cqr", "scp_crepes").method.name == "scp_crepes"
    with pytest.raises(ConfigError, match="add scp_mapie") as caught:
        built(files, "cqr")
    assert caught.value.where == "arm"


@pytest.mark.parametrize("method", ["scp_mapie", "scp_spread"])
def test_what_never_changes_is_computed_once(files: Path, method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    robot = built(files, method)
    predicted_rows: list[int] = []
    predict = Prepared.predicted

    def counted(prepared: Prepared, rows: Array) -> Array:
        predicted_rows.append(len(rows))
        return predict(prepared, rows)

    monkeypatch.setattr(Prepared, "predicted", counted)
    new = bending_arm(7, n_markers=2, seed=9)
    robot.intervals(new.commands, [0.9])
    robot.box(0.9)
    robot.p_values(new.commands, new.positions)
    assert predicted_rows == [7, 7]
