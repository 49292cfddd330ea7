from __future__ import annotations

import numpy as np
import pytest

from softkin.models.plain import evaluate
from softkin.models.plain.evaluate import regressor
from softkin.models.plain.kernels import Node


def line(slope: float, constant: float = 0.0) -> Node:
    ones = np.ones(1)
    node = {"kind": "polynomial", "factors": np.array([[0]]), "mean": 0 * ones, "scale": ones}
    return node | {"weights": np.array([[slope]]), "constant": np.array([constant])}


def test_a_polynomial_has_products_of_its_features() -> None:
    node = line(1.0) | {"factors": np.array([[0, 2], [0, 1]]), "mean": np.array([1.0, 0.0]), "scale": np.ones(2)}
    node["weights"] = np.array([[2.0], [3.0]])
    np.testing.assert_allclose(regressor(node)(np.array([[2.0, 5.0]]))[0], [[2 * (2 - 1) + 3 * 2 * 5]])


def test_parts_of_a_trend_and_a_mean_are_added() -> None:
    node: Node = {"kind": "detrended", "trend": line(1.0), "rest": line(0.0, 2.0), "scale": np.array([3.0])}
    assert regressor(node)(np.array([[5.0]]))[0] == 11.0
    mean: Node = {"kind": "mean", "members": [line(1.0), line(3.0)], "shares": np.array([0.25, 0.75])}
    targets, spread = regressor(mean)(np.array([[2.0]]))
    assert targets == 5.0
    assert spread is None


def test_many_rows_are_answered_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    term = {"shape": "exponential", "constant": 1.0, "rate": 0.5, "lengths": np.ones(1)}
    node: Node = {"kind": "kernel", "points": np.zeros((3, 1)), "terms": [term], "constant": np.zeros(1)}
    node["weights"], rows = np.ones((3, 1)), np.linspace(-1, 1, 7)[:, None]
    whole = regressor(node)(rows)[0]
    monkeypatch.setattr(evaluate, "NUMBERS_AT_ONCE", 12)
    np.testing.assert_array_equal(regressor(node)(rows)[0], whole)


def network(rng: np.random.Generator, activation: str = "tanh") -> Node:
    sizes = [(2, 5), (5, 4), (4, 3)]
    node: Node = {"kind": "network", "activation": activation}
    return node | {
        "weights": [rng.normal(size=size) for size in sizes],
        "biases": [rng.normal(size=n) for _, n in sizes],
    }


def test_networks_that_are_alike_are_averaged_as_one_by_one() -> None:
    rng = np.random.default_rng(0)
    members, shares, rows = [network(rng) for _ in range(3)], np.array([0.5, 0.3, 0.2]), rng.normal(size=(6, 2))
    one_by_one = sum(share * regressor(member)(rows)[0] for share, member in zip(shares, members, strict=True))
    for others in ([], [network(rng, "relu")]):
        node = {"kind": "mean", "members": members + others, "shares": np.append(shares, np.zeros(len(others)))}
        for some in (rows, rows[:1]):
            targets, spread = regressor(node)(some)
            np.testing.assert_allclose(targets, one_by_one[: len(some)], rtol=1e-13)
            assert spread is None


def test_one_row_has_the_terms_that_many_have() -> None:
    rng = np.random.default_rng(0)
    node = line(1.0) | {
        "factors": np.array([[0, 0, 1], [0, 2, 2], [1, 1, 2]]),
        "mean": np.zeros(3),
        "scale": np.ones(3),
    }
    node["weights"], rows = rng.normal(size=(3, 1)), rng.normal(size=(5, 2))
    each = [regressor(node)(row[None])[0][0] for row in rows]
    np.testing.assert_allclose(each, regressor(node)(rows)[0], rtol=1e-14)
