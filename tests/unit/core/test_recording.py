"""Memory of commands: play operators and their laws."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from softkin.core.recording import WIDTHS, CommandMemory, gaps, memory_columns, n_input_columns, play
from softkin.core.samples import Array

SEQUENCES = arrays(np.float64, st.tuples(st.integers(2, 30), st.just(2)), elements=st.floats(-10, 10, width=32))
HALF = st.floats(0.01, 5)
REST = np.zeros(2)


def last(commands: Array, half_width: float, start: Array = REST) -> Array:
    return np.asarray(play(commands, half_width, start)[-1])


@given(SEQUENCES, HALF)
def test_a_play_operator_stays_within_its_width(commands: Array, half: float) -> None:
    assert (np.abs(play(commands, half, REST) - commands) <= half + 1e-9).all()


@given(SEQUENCES, HALF, st.integers(1, 5))
def test_it_does_not_know_how_fast_commands_come(commands: Array, half: float, pauses: int) -> None:
    """Rate independence: poses in between on the way to a command, and pauses, change nothing."""
    ways = np.vstack([REST, commands])
    slow = np.vstack([np.linspace(a, b, 4 * pauses + 1)[1:] for a, b in pairwise(ways)])
    paused = np.repeat(commands, pauses, axis=0)
    np.testing.assert_allclose(last(slow, half), last(commands, half), atol=1e-9)
    np.testing.assert_array_equal(last(paused, half), last(commands, half))


@given(SEQUENCES, HALF, st.floats(0, 5))
def test_a_larger_swing_wipes_out_what_came_before(commands: Array, half: float, margin: float) -> None:
    """The wiping-out property (Krasnosel'skii and Pokrovskii 1989)."""
    largest = np.full((1, 2), np.abs(commands).max() + 2 * half + margin)
    after = np.vstack([commands, largest, -largest])
    np.testing.assert_allclose(last(after, half), -largest[0] + half)


@given(SEQUENCES, HALF, st.floats(0, 3))
def test_it_is_monotone(commands: Array, half: float, lift: float) -> None:
    raised = play(commands + lift, half, REST)
    assert (raised >= play(commands, half, REST) - 1e-9).all()


@given(SEQUENCES)
def test_memory_goes_on_where_it_was_left(commands: Array) -> None:
    memory = CommandMemory(REST, np.full(2, 20.0))
    whole, first = memory.along(commands), memory.along(commands[:1])
    rest = memory.along(commands[1:], first[-1], commands[0])
    np.testing.assert_array_equal(np.vstack([first, rest]), whole)
    columns = memory_columns(2)
    assert len(columns) == whole.shape[1] == len(memory.start())
    assert n_input_columns(2) == 2 + len(columns) + 1
    half = WIDTHS[1] * 20.0
    plays = whole[:, [columns.index("play2_u1"), columns.index("play2_u2")]]
    np.testing.assert_allclose(plays, play(commands, half, REST), atol=1e-9)
    np.testing.assert_array_equal(whole[1:, :2], commands[:-1])


@given(SEQUENCES)
def test_each_of_several_next_commands_is_remembered_as_if_sent(commands: Array) -> None:
    robot = CommandMemory(REST, np.ones(2))
    before = robot.along(commands)[-1]
    candidates = commands[::-1] + 0.3
    sent = [robot.along(one[None], before, commands[-1])[0] for one in candidates]
    np.testing.assert_array_equal(robot.next_after(candidates, before, commands[-1]), sent)


def test_a_session_begins_at_rest_whatever_the_order_of_rows() -> None:
    commands = np.array([[1.0], [5.0], [2.0], [9.0]])
    memory = CommandMemory.of(commands)
    assert memory.rest == 1.0  # zero is no command of this robot
    recorded = memory.recorded(commands, np.array([4, 1, 3, 2]), np.array([2, 1, 2, 1]))
    assert recorded.memory[:, 0].tolist() == [2.0, 1.0, 1.0, 5.0]


def test_gaps_are_counted() -> None:
    assert gaps([3, 4, 5]) == 0
    assert gaps([1, 4, 9]) == 6
