from __future__ import annotations

import warnings

import numpy as np

from softkin.models.plain.expansion import expansion
from softkin.models.plain.kernels import Node

RNG = np.random.default_rng(0)
POWERS = np.array([[0, 0], [1, 0], [0, 3], [2, 1]])
PART: Node = {"lengths": np.array([2.0, 0.5]), "rate": 0.5, "powers": POWERS, "reach": 3.0}
PART["weights"] = RNG.normal(size=(4, 2))


def test_it_is_the_weighed_powers_within_an_envelope() -> None:
    x = RNG.normal(size=(30, 2))
    targets, holds = expansion([PART, PART | {"rate": 0.0, "reach": np.inf}])(x)
    z = x / PART["lengths"]
    products = np.prod(z[:, None] ** POWERS, axis=2) @ PART["weights"]
    wanted = products * (1 + np.exp(-0.5 * (z**2).sum(axis=1)))[:, None]
    np.testing.assert_array_equal(holds, np.linalg.norm(z, axis=1) <= 3.0)
    assert 0 < holds.sum() < 30
    np.testing.assert_allclose(targets[holds], wanted[holds], rtol=1e-13)


def test_commands_however_far_raise_no_warning() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _, holds = expansion([PART])(np.array([[1e100, -1e100], [0.0, 0.0]]))
    assert holds.tolist() == [False, True]
