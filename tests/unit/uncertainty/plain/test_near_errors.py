from __future__ import annotations

import numpy as np
import pytest

from softkin.uncertainty.plain import near_errors as module
from softkin.uncertainty.plain.near_errors import mean_of_nearest, near_errors, of_one_command, squared_distances
from tests.exported_robots import NEW, hard_somewhere

NUMBERS = hard_somewhere().known.difficulty.numbers  # type: ignore[attr-defined]


def test_points_as_near_as_the_farthest_of_the_nearest_count_too() -> None:
    squares, errors = np.array([[4.0, 1.0, 1.0 + 1e-12, 9.0]]), np.array([[8.0], [1.0], [3.0], [7.0]])
    np.testing.assert_array_equal(mean_of_nearest(squares, errors, 1), [[2.0]])
    np.testing.assert_array_equal(mean_of_nearest(squares, errors, 3), [[4.0]])


def test_distances_between_commands_or_between_norms() -> None:
    points, rows = np.array([[3.0, 4.0], [0.0, 0.0]]), np.array([[0.0, 5.0]])
    np.testing.assert_array_equal(squared_distances(points, rows, False), [[10.0, 25.0]])
    np.testing.assert_array_equal(squared_distances(points, rows, True), [[0.0, 25.0]])


def test_rounding_of_commands_on_a_grid_changes_nothing() -> None:
    on_grid = NUMBERS["points"] * NUMBERS["scale"] + NUMBERS["mean"]
    shaken = on_grid * (1 + 1e-14 * np.random.default_rng(0).uniform(-1, 1, on_grid.shape))
    np.testing.assert_allclose(near_errors(NUMBERS, shaken), near_errors(NUMBERS, on_grid), rtol=1e-12)


def test_many_commands_are_answered_part_by_part(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = near_errors(NUMBERS, NEW)
    monkeypatch.setattr(module, "HELD_AT_ONCE", 1000)
    np.testing.assert_allclose(near_errors(NUMBERS, NEW), whole, rtol=1e-14)
    assert near_errors(NUMBERS, NEW[:0]).shape == (0, 6)


def test_one_command_is_answered_as_among_many_by_distance_and_by_norm() -> None:
    n_columns = len(NUMBERS["shares"])
    mixed = NUMBERS | {
        "by_norm": np.arange(n_columns) % 2 == 0,
        "neighbours": 5 + np.arange(n_columns),
        "shares": np.where(np.arange(n_columns) == 2, 0.0, 0.75),
    }
    mixed["column"] = np.append(np.arange(n_columns), -1)
    on_grid = mixed["points"][:20].round(1) * mixed["scale"] + mixed["mean"]
    for node in (NUMBERS, mixed):
        one = of_one_command(node)
        for rows in (NEW[:40], on_grid):
            each = np.vstack([one(row[None]) for row in rows])
            np.testing.assert_allclose(each, near_errors(node, rows), rtol=1e-13)


@pytest.mark.parametrize("n_commands", [1, 2, 3])
def test_rows_cell_by_cell_have_the_nearest_of_all_points(n_commands: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(0)
    points, errors = rng.uniform(-1, 1, (300, n_commands)).round(1), rng.exponential(1.0, (300, 4))
    node = {
        "mean": np.zeros(n_commands),
        "scale": np.ones(n_commands),
        "points": points,
        "errors": errors,
        "by_norm": np.array([False, True, False, True]),
        "neighbours": np.array([3, 10, 40, 3]),
        "shares": np.array([1.0, 0.5, 0.75, 0.0]),
        "column": np.array([0, 1, 2, 3, -1]),
        "least": 0.05,
    }
    rows = np.vstack(
        [rng.uniform(-3, 3, (1500, n_commands)), np.repeat(points, 5, axis=0), np.full((1, n_commands), 1e9)]
    )
    monkeypatch.setattr(module, "ROWS_OF_A_CELL", len(rows))
    at_once = near_errors(node, rows)
    monkeypatch.setattr(module, "ROWS_OF_A_CELL", 20)
    np.testing.assert_allclose(near_errors(node, rows), at_once, rtol=1e-13)
    squares = squared_distances(points, rows, False)
    np.testing.assert_allclose(at_once[:, 0], np.maximum(mean_of_nearest(squares, errors[:, :1], 3)[:, 0], 0.05))
