"""Commands sought among bounds, of positions that are plain functions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.command_search import CommandSearch
from tests.recorded_robot import bent

Position = Callable[[Array], Array]


def search(position: Position, n_commands: int = 2, fixed: int | None = None) -> CommandSearch:
    lower, upper = -np.ones(n_commands), np.ones(n_commands)
    if fixed is not None:
        lower[fixed] = upper[fixed] = 0.25
    return CommandSearch(position, lambda rows: np.abs(rows[:, -1]) > 0.9, lower, upper, 100.0, 1e-4)


class Listed:
    """The same starts for every target."""

    def __init__(self, *starts: Array) -> None:
        self.starts, self.n_rounds = starts, len(starts)

    def of_round(self, place: int, targets: NDArray[np.intp]) -> Array:
        return np.tile(self.starts[place], (len(targets), 1))


def sought(own: CommandSearch, target: Array, starts: list[Array], last: Array | None, *, first_wins: bool) -> Array:
    """The command (n_commands,) of one target (3,)."""
    return np.asarray(own.nearest_each(target[None], Listed(*starts), last, first_wins=first_wins)[0])


def shared(commands: Array) -> Array:
    """Two drives for x and two for y: what each of a pair does the other may do."""
    return bent(np.column_stack([commands[:, 0] + commands[:, 2], commands[:, 1] + commands[:, 3]]) / 2)


def test_an_end_of_the_range_is_reached_and_never_passed() -> None:
    corner = np.array([1.0, -1.0])
    found = sought(search(bent), bent(corner[None])[0], [np.zeros(2)], None, first_wins=True)
    np.testing.assert_allclose(found, corner, atol=1e-6)
    far = sought(search(bent), bent(3 * corner[None] / 2)[0], [np.zeros(2)], None, first_wins=True)
    np.testing.assert_allclose(far, corner)


def test_a_command_that_never_varies_is_kept() -> None:
    found = sought(search(bent, fixed=1), bent(np.array([[0.5, 0.25]]))[0], [np.zeros(2)], None, first_wins=True)
    np.testing.assert_allclose(found, [0.5, 0.25], atol=1e-7)


def test_of_redundant_commands_the_nearest_to_the_last_is_taken() -> None:
    last, target = np.array([0.6, 0.0, -0.2, 0.4]), bent(np.array([[0.4, -0.1]]))[0]
    found = sought(search(shared, 4), target, [last, np.zeros(4)], last, first_wins=False)
    np.testing.assert_allclose(shared(found[None])[0], target, atol=1e-6)
    # The pairs must sum to 0.8 and -0.2: each command moves by half of what is missing.
    np.testing.assert_allclose(found, last + np.array([0.2, -0.3, 0.2, -0.3]), atol=1e-3)


def test_of_two_solutions_one_in_domain_is_taken() -> None:
    """y is a square of the second command: -0.95 and 0.95 do the same, and only one of them is within."""
    both = CommandSearch(
        lambda rows: np.column_stack([rows[:, 0], rows[:, 1] ** 2, 0 * rows[:, 0]]), lambda rows: rows[:, 1] > 0.9,
        -np.ones(2), np.ones(2), 1.0, 1e-6,
    )  # fmt: skip
    starts = [np.array([0.0, 0.8]), np.array([0.0, -0.8])]
    last = np.array([0.0, 0.9])
    found = sought(both, np.array([0.1, 0.9025, 0.0]), starts, last, first_wins=False)
    np.testing.assert_allclose(found, [0.1, -0.95], atol=1e-6)
    first = sought(both, np.array([0.1, 0.64, 0.0]), starts, last, first_wins=False)
    np.testing.assert_allclose(first, [0.1, 0.8], atol=1e-6)


@pytest.mark.parametrize("width", [0.02, 0.1])
def test_where_positions_are_steps_they_are_probed(width: float) -> None:
    """Of a tree derivatives are 0: steps along the axes come as near as its steps allow."""

    def stairs(rows: Array) -> Array:
        return bent(width * np.round(rows / width))

    target = bent(np.array([[0.43, -0.27]]))[0]
    start = np.array([-0.3, 0.6])
    found = sought(search(stairs), target, [start], None, first_wins=True)
    np.testing.assert_array_equal(sought(search(stairs), target, [start, start], start, first_wins=False), found)
    grid = np.stack(np.meshgrid(*2 * [np.arange(-1, 1.01, width)]), axis=-1).reshape(-1, 2)
    nearest = np.linalg.norm(stairs(grid) - target, axis=1).min()
    assert np.linalg.norm(stairs(found[None])[0] - target) <= 1.01 * nearest
