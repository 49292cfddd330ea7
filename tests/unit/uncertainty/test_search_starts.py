"""Commands that searches for targets begin at."""

from __future__ import annotations

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.search_starts import LEAST_APART, N_STARTS, SearchStarts

RNG = np.random.default_rng(0)
COMMANDS, TARGETS = RNG.uniform(-1, 1, (300, 2)), RNG.uniform(-1, 1, (7, 3))
POSITIONS, WIDTH = np.column_stack([COMMANDS, COMMANDS[:, 0] * COMMANDS[:, 1]]), np.full(2, 2.0)
EVERY = np.arange(len(TARGETS))


def starts(last: Array | None = None, *, in_a_row: bool = False, commands: Array = COMMANDS) -> SearchStarts:
    return SearchStarts(TARGETS, POSITIONS[: len(commands)], commands, WIDTH, last, in_a_row=in_a_row)


def test_the_nearest_goes_first_and_each_next_is_the_nearest_of_those_apart() -> None:
    asked = starts()
    assert asked.n_rounds == N_STARTS
    found = np.stack([asked.of_round(place, EVERY) for place in range(N_STARTS)], axis=1)
    for target, own in zip(TARGETS, found, strict=True):
        left = COMMANDS[np.argsort(np.linalg.norm(POSITIONS - target, axis=1))]
        for command in own:
            np.testing.assert_array_equal(command, left[0])
            left = left[np.linalg.norm((left - command) / WIDTH, axis=1) >= LEAST_APART]


def test_the_last_command_comes_second_or_in_a_row_first() -> None:
    last = np.array([0.1, 0.2])
    alone, second, first = starts(), starts(last), starts(last, in_a_row=True)
    assert second.n_rounds == first.n_rounds == N_STARTS + 1
    nearest = alone.of_round(0, EVERY)
    np.testing.assert_array_equal(second.of_round(0, EVERY), nearest)
    np.testing.assert_array_equal(second.of_round(1, EVERY), np.tile(last, (len(EVERY), 1)))
    np.testing.assert_array_equal(first.of_round(0, EVERY), np.tile(last, (len(EVERY), 1)))
    np.testing.assert_array_equal(first.of_round(1, EVERY), nearest)
    np.testing.assert_array_equal(second.of_round(2, EVERY), alone.of_round(1, EVERY))


def test_some_targets_are_asked_for_as_among_all() -> None:
    whole, part = starts(), starts()
    for asked in (whole, part):
        asked.of_round(0, EVERY)
    some = np.array([1, 4])
    np.testing.assert_array_equal(part.of_round(1, some), whole.of_round(1, EVERY)[some])
    np.testing.assert_array_equal(part.of_round(2, some[1:]), whole.of_round(2, EVERY)[some[1:]])


def test_where_all_commands_are_near_each_other_there_is_one_start() -> None:
    asked = starts(commands=COMMANDS[:1] + 0.01 * COMMANDS[:50])
    assert not np.isnan(asked.of_round(0, EVERY)).any()
    assert np.isnan(asked.of_round(1, EVERY)).all()
