"""What every stand-in of the registry must do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from softkin.core.samples import Array, informative_coordinates
from softkin.data.standins import STANDINS
from softkin.data.standins.robot import StandIn
from tests.contract import laws

N_ROWS = 24
#: A robot's markers range over this, in mm.
PLAUSIBLE_MM = (10.0, 10_000.0)


def commands(robot: StandIn, seed: int = 0, n_rows: int = N_ROWS) -> Array:
    return robot.draw(n_rows, np.random.default_rng(seed))


def poses(robot: StandIn, sent: Array, seed: int = 1) -> Array:
    return robot.poses(sent, np.random.default_rng(seed))


def is_named(name: str, robot: StandIn) -> None:
    laws.has_name_and_title(name, robot)
    assert robot.n_commands > 0
    assert robot.n_markers > 0


def draws_distinct_commands(_name: str, robot: StandIn) -> None:
    drawn = commands(robot, n_rows=500)
    assert drawn.shape == (500, robot.n_commands)
    assert np.isfinite(drawn).all()
    assert len(np.unique(drawn, axis=0)) == 500
    assert (np.ptp(drawn, axis=0) > 0).all()


def takes_poses_in_mm(_name: str, robot: StandIn) -> None:
    """All coordinates of all markers, of which some move as far as a robot does."""
    positions = poses(robot, commands(robot))
    assert positions.shape == (N_ROWS, 3 * robot.n_markers)
    assert np.isfinite(positions).all()
    assert informative_coordinates(positions).any()
    assert PLAUSIBLE_MM[0] < np.ptp(positions, axis=0).max() < PLAUSIBLE_MM[1]


def repeats_itself_under_a_seed(_name: str, robot: StandIn) -> None:
    """To the bit, and draws other commands by another."""
    with laws.global_random_states_kept():
        sent, again = commands(robot), commands(robot)
        np.testing.assert_array_equal(sent, again)
        assert (commands(robot, seed=5) != sent).any()
        with laws.inputs_kept(sent):
            one, two = (poses(robot, sent[:6]) for _ in range(2))
    np.testing.assert_array_equal(one, two)


def starts_from_rest(_name: str, robot: StandIn) -> None:
    """Whatever memory it has, the first pose depends on the first command alone."""
    sent = commands(robot)[:4]
    np.testing.assert_allclose(poses(robot, sent)[0], poses(robot, sent[:1])[0], atol=1e-3)


LAWS = (is_named, draws_distinct_commands, takes_poses_in_mm, repeats_itself_under_a_seed, starts_from_rest)


def check_standin(name: str, robot: StandIn) -> None:
    for law in LAWS:
        law(name, robot)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", STANDINS)
def test_every_standin_keeps_the_contract(name: str, law: Callable[[str, StandIn], None]) -> None:
    law(name, STANDINS[name])


def arm(draw: Callable[[Array], Array] = np.asarray, move: Callable[[Array], Array] = np.asarray) -> StandIn:
    """A straight robot of two commands and one marker, of which something is changed."""

    def drawn(n_rows: int, rng: np.random.Generator) -> Array:
        return draw(rng.uniform(-1, 1, (n_rows, 2)))

    def taken(sent: Array, _: np.random.Generator) -> Array:
        return move(100.0 * np.column_stack([sent, np.ones(len(sent))]))

    return StandIn("straight", "straight arm", 2, 1, drawn, taken)


def test_a_straight_arm_keeps_the_contract() -> None:
    check_standin("straight", arm())


def shifted(positions: Array) -> Array:
    return positions + len(positions)


@pytest.mark.parametrize(
    ("law", "fault"),
    [
        (draws_distinct_commands, {"draw": np.round}),
        (draws_distinct_commands, {"draw": lambda drawn: drawn * [1.0, 0.0]}),
        (draws_distinct_commands, {"draw": lambda drawn: drawn[:, :1]}),
        (takes_poses_in_mm, {"move": lambda positions: positions / 1000.0}),
        (takes_poses_in_mm, {"move": lambda positions: positions[:, :2]}),
        (takes_poses_in_mm, {"move": lambda positions: np.where(positions > 90.0, np.nan, positions)}),
        (repeats_itself_under_a_seed, {"move": lambda positions: positions + np.random.random()}),
        (repeats_itself_under_a_seed, {"draw": lambda drawn: drawn + np.random.default_rng().random()}),
        (repeats_itself_under_a_seed, {"draw": lambda drawn: np.arange(float(drawn.size)).reshape(drawn.shape)}),
        (starts_from_rest, {"move": shifted}),
    ],
)
def test_the_contract_is_broken_by(law: Callable[[str, StandIn], None], fault: dict[str, Any]) -> None:
    for check in (law, check_standin):
        with pytest.raises(AssertionError):
            check("straight", arm(**fault))


def test_another_name_breaks_the_contract() -> None:
    with pytest.raises(AssertionError):
        check_standin("bent", replace(arm(), title="bent arm"))
