from __future__ import annotations

from pathlib import Path

import numpy as np

from softkin.core.files import write_json
from softkin.core.runs import Run
from softkin.training.members import all_members, as_records, combined, members_of, members_of_runs

GP, LR, MEAN = Run("gp", "outer"), Run("lr", "tuned"), Run("ensemble", "outer")
WEIGHTS = {GP: 0.75, LR: 0.25}


def records(folder: Path) -> dict[Run, Path]:
    files = {run: folder / f"{run.model}.json" for run in (GP, LR, MEAN)}
    for run, file in files.items():
        write_json(file, {"params": {}, **({"members": as_records(WEIGHTS)} if run == MEAN else {})})
    return files


def test_a_run_of_a_model_is_its_own_member_and_an_ensemble_has_those_of_its_record(tmp_path: Path) -> None:
    files = records(tmp_path)
    assert members_of(LR, files[LR]) == {LR: 1.0}
    assert members_of(MEAN, files[MEAN]) == WEIGHTS


def test_a_member_of_several_runs_is_fitted_once(tmp_path: Path) -> None:
    weights = members_of_runs([LR, MEAN], records(tmp_path))
    assert all_members(weights) == [LR, GP]
    assert all_members({}) == []


def test_what_members_predict_is_combined_part_by_part_and_only_the_asked_runs_are_kept(tmp_path: Path) -> None:
    weights = members_of_runs([LR, MEAN], records(tmp_path))
    parts = {(run, part): np.full((2, 3), size) for run, size in ((LR, 4.0), (GP, 8.0)) for part in ("0", "1")}
    made = combined(parts, weights)
    assert set(made) == {(LR, "0"), (LR, "1"), (MEAN, "0"), (MEAN, "1")}
    np.testing.assert_array_equal(made[MEAN, "1"], np.full((2, 3), 7.0))
    np.testing.assert_array_equal(made[LR, "0"], parts[LR, "0"])
