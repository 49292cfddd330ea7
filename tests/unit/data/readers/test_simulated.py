from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.errors import ConfigError
from softkin.core.files import write_json
from softkin.core.samples import SUBSETS
from softkin.data.readers.simulated import RECIPE, read
from softkin.data.standins.simulating import simulate

ROWS = {"train": 12, "validation": 2, "test": 3, "extrapolation": 4}


def recipe(folder: Path, **changes: object) -> Path:
    path = folder / "raw"
    write_json(path, {"robot": "tendon_finger", "seed": 7, "rows": ROWS} | changes)
    return path


def test_a_recipe_is_simulated_to_the_bit(tmp_path: Path) -> None:
    path = recipe(tmp_path)
    samples = read(path, dataset="finger_standin", source={})
    expected = simulate("tendon_finger", n_rows=ROWS, seed=7)
    assert tuple(samples) == SUBSETS
    for subset, rows in samples.items():
        assert len(rows) == ROWS[subset]
        assert rows.commands.tobytes() == expected[subset].commands.tobytes()
        assert rows.positions.tobytes() == expected[subset].positions.tobytes()


def test_the_recipe_alone_decides(tmp_path: Path) -> None:
    """Whatever else its entry says."""
    one = read(recipe(tmp_path), dataset="a", source={})["train"]
    other = read(recipe(tmp_path), dataset="b", source={"robot": "pneumatic_arm", "seed": 1, "rows": 1})["train"]
    assert one.positions.tobytes() == other.positions.tobytes()
    reseeded = read(recipe(tmp_path, seed=8), dataset="a", source={})["train"]
    assert one.positions.tobytes() != reseeded.positions.tobytes()
    assert set(RECIPE) == {"robot", "seed", "rows"}


def test_an_unknown_robot_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="stand-in 'snake': unknown"):
        read(recipe(tmp_path, robot="snake"), dataset="a", source={})
