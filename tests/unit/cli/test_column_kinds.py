from __future__ import annotations

import numpy as np

from softkin.cli.column_kinds import (
    affine_copies,
    are_alike,
    computed,
    is_running,
    numbered_positions,
    quaternions,
    running_number,
)


def test_differences_and_outputs_of_models_are_seen_by_their_names() -> None:
    assert computed(["dl1", "x_pcc", "x_real", "dx", "dy", "dz"]) == ["x_pcc", "dx", "dy", "dz"]
    assert computed(["dx", "u1", "error_mm"]) == ["error_mm"]


def test_four_columns_of_unit_norm_are_an_orientation() -> None:
    raw = np.random.default_rng(0).normal(size=(50, 4))
    names = ["q0", "q1", "q2", "q3"]
    unit = raw / np.linalg.norm(raw, axis=1, keepdims=True)
    assert quaternions(["u", *names], dict(zip(["u", *names], [raw[:, 0], *unit.T], strict=True))) == names
    assert quaternions(names, dict(zip(names, raw.T, strict=True))) == []
    metres = np.column_stack([np.ones(50), 0.05 * raw[:, :3]])
    assert np.abs(np.linalg.norm(metres, axis=1) - 1).max() < 0.02
    assert quaternions(names, dict(zip(names, metres.T, strict=True))) == []
    about_z = np.column_stack([np.zeros(50), np.zeros(50), np.sin(0.1 * raw[:, 0]), np.cos(0.1 * raw[:, 0])])
    assert quaternions(names, dict(zip(names, about_z.T, strict=True))) == names


def test_three_numbered_columns_of_one_stem() -> None:
    assert numbered_positions(["y1", "y2", "y3", "a"]) == ["y1", "y2", "y3"]
    assert numbered_positions(["y1", "y2", "y3", "v_1", "v_2", "v_3"]) == []
    assert numbered_positions(["y1", "y2"]) == []


def test_running_numbers_and_rows_that_follow_each_other() -> None:
    assert is_running(np.arange(5.0))
    assert not is_running(np.array([0.0, 2.0, 1.0]))
    assert not is_running(np.array(["a", "b", "c"], dtype=object))
    time = np.linspace(0, 20, 400)
    walk = np.column_stack([np.sin(time), np.cos(1.3 * time)])
    assert are_alike(walk)
    assert not are_alike(np.random.default_rng(1).permutation(walk))


def test_an_affine_map_of_the_commands_is_no_measurement() -> None:
    commands = np.random.default_rng(0).normal(size=(60, 2))
    positions = commands @ np.array([[1.0, 2.0, 0.0], [0.5, 0.0, 1.0]]) + 3.0
    assert affine_copies(commands, positions)
    assert not affine_copies(commands, positions + 0.1 * commands[:, :1] ** 2)


def test_a_running_number_is_one_by_its_name_and_its_numbers() -> None:
    columns = {"id": np.array([3.0, 1.0, 2.0]), "frame": np.arange(3.0), "u": np.arange(3.0)}
    assert running_number({"u": "command", "id": "ignored", "frame": "ignored"}, columns) == "frame"
    assert running_number({"u": "command", "id": "ignored"}, columns) is None
