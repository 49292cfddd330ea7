from __future__ import annotations

from typing import Any

import numpy as np

from softkin.models.plain.evaluate import regressor
from softkin.models.plain.kernels import Node
from softkin.models.plain.spaces import space
from softkin.uncertainty.plain.members import Members

RNG = np.random.default_rng(0)
SCALED: Node = {"space": "scaled", "kept": np.arange(3), "mean": np.array([0.1, -0.2, 90.0]), "scale": np.ones(3)}
ARCS: Node = {"space": "arcs", "n_arcs": 3, "moving": np.array([0]), "near_constant": np.array([], dtype=int)}
ARCS |= {"constants": np.zeros((1, 3)), "origin": np.zeros(3), "axes": np.eye(3)}
SCALED["constants"] = np.zeros(3)


def arcs() -> Node:
    return ARCS | {"arcs": {key: np.copy(value) if key != "space" else value for key, value in SCALED.items()}}


def member(where: Node, widths: tuple[int, ...] = (), *, has_step: bool = False) -> Node:
    n_features = 2 * (1 + has_step + len(widths))
    line: dict[str, Any] = {"kind": "polynomial", "factors": np.arange(n_features)[:, None], "constant": np.zeros(3)}
    line |= {"mean": np.zeros(n_features), "scale": np.ones(n_features), "weights": RNG.normal(size=(n_features, 3))}
    return {"regressor": line, "space": where, "has_step": has_step, "widths": np.array(widths, dtype=np.int64)}


PARTS = [member(arcs(), (1, 3), has_step=True), member(SCALED), member(arcs(), (1, 3), has_step=True), member(arcs())]
NUMBERS: Node = {"members": PARTS, "shares": np.array([0.4, 0.3, 0.2, 0.1]), "n_commands": 2}


def test_members_of_one_space_are_placed_together_as_each_alone() -> None:
    inputs = RNG.normal(size=(7, 2 * 7 + 1))
    commands, plays = inputs[:, :2], inputs[:, 4:-1].reshape(7, 5, 2)
    stops = (commands[:, None] - plays[:, [1, 3]]).reshape(7, -1)
    told = np.hstack([commands, commands - inputs[:, 2:4], stops])
    features = [told, commands, told, commands]
    alone = [
        space(part["space"]).positions(regressor(part["regressor"])(given)[0])
        for part, given in zip(PARTS, features, strict=True)
    ]
    expected = np.tensordot(NUMBERS["shares"], np.stack(alone), 1)
    members = Members(NUMBERS)
    assert [group for _, group in members.spaces] == [[0, 2, 3], [1]]
    np.testing.assert_allclose(members.placed(inputs)[0], expected, rtol=1e-13)
    np.testing.assert_allclose(members.placed(inputs[:1])[0], expected[:1], rtol=1e-13)


def test_spaces_of_other_numbers_are_not_taken_together() -> None:
    moved = SCALED | {"mean": np.array([0.1, -0.2, 91.0])}
    members = Members(NUMBERS | {"members": [member(SCALED), member(moved)], "shares": np.array([0.5, 0.5])})
    assert len(members.spaces) == len(members) == 2
    assert not len(Members(NUMBERS | {"members": [], "shares": np.zeros(0)}))
