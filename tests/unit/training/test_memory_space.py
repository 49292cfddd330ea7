"""The search for memory: a recording's study chooses it, all others never hear of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import optuna
import pytest

from softkin.core.files import read_json
from softkin.core.runs import OUTER, TUNED
from softkin.core.samples import Samples
from softkin.data.table import to_table, write_table
from softkin.models import MODELS
from softkin.training.held_out import Robot
from softkin.training.memory_space import drawn_memory, first_memories, simplest, taken_memory
from softkin.training.study import TuningResult, TuningSettings
from softkin.training.tune import PresetFiles, SearchSettings, tune_table
from tests.recorded_robot import recorded_arm

FIRST = [{"C": 1.0}, {"C": 2.0}, {"C": 3.0}]


def test_what_is_drawn_is_taken_again() -> None:
    study = optuna.create_study(sampler=optuna.samplers.RandomSampler(seed=0))
    seen = set()
    for _ in range(30):
        params = drawn_memory(study.ask()) | {"C": 1.0}
        seen.add(params["memory"])
        memory = taken_memory(params)
        assert params == {"C": 1.0}
        assert memory is not None
        assert memory["zeros"]
        assert ("widths" in memory) == (memory["memory"] == "play")
    assert seen == {"none", "previous", "play"}
    assert taken_memory({"C": 1.0}) is None


def test_each_memory_is_tried_before_pruning_begins(samples: Samples) -> None:
    assert first_memories(FIRST, samples) is FIRST
    tried = first_memories(FIRST, recorded_arm(20))
    assert [trial["memory"] for trial in tried] == ["play", "play", "none", "previous", "play"]
    assert [trial["C"] for trial in tried] == [1.0, 2.0, 1.0, 1.0, 3.0]


def result(*scores: tuple[str, float]) -> TuningResult:
    complete = [({"memory": memory}, score) for memory, score in scores]
    return TuningResult(*complete[0], None, "", complete)


def test_a_memory_must_be_worth_it() -> None:
    assert simplest(result(("play", 1.0), ("previous", 1.01), ("none", 1.019))).params == {"memory": "none"}
    assert simplest(result(("play", 1.0), ("previous", 1.01), ("none", 1.021))).params == {"memory": "previous"}
    kept = result(("play", 1.0), ("previous", 1.1))
    assert simplest(kept) == kept
    static = replace(kept, complete=[({"C": 1.0}, 1.0), ({"C": 2.0}, 1.0)], params={"C": 1.0})
    assert simplest(static) == static


def chosen(rows: Samples, folder: Path) -> tuple[dict[str, Any], float]:
    table = folder / "table.parquet"
    write_table(to_table({"train": rows}), table)
    endings = ("journal", "json", "csv", "npz")
    files = {p: PresetFiles(*(folder / f"{p}.{ending}" for ending in endings)) for p in (TUNED, OUTER)}
    tune_table(
        table,
        spec=MODELS["gp"],
        robot=Robot(base=None, standardised_norm=True),
        settings=TuningSettings(n_trials=6, n_folds=3, max_rows=200, seed=0),
        search=SearchSettings(dict.fromkeys(files, 6), files, 1, [0.6, 0.8], ["cartesian"]),
        files=files,
        code="",
        threads=1,
    )
    best = read_json(folder / "tuned.json")
    return best["memory"], best["cv_mae_mm"]


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_a_robot_without_memory_gets_none_and_loses_nothing(tmp_path: Path, seed: int) -> None:
    rows = recorded_arm(200, seed=seed)
    memory, error = chosen(rows, tmp_path)
    assert memory["memory"] == "none"
    (tmp_path / "static").mkdir()
    static, without = chosen(Samples(rows.commands, rows.positions), tmp_path / "static")
    assert static is None
    assert error < 1.05 * without


def test_a_robot_with_backlash_gets_play_operators(tmp_path: Path) -> None:
    memory, _ = chosen(recorded_arm(200, backlash=0.04), tmp_path)
    assert memory["memory"] == "play"
    assert np.isfinite(memory["zeros"])
