from __future__ import annotations

import numpy as np

from softkin.models.plain.kernels import Node
from softkin.uncertainty.export.c_nodes import c_function, has_spread, n_targets
from softkin.uncertainty.export.c_text import Tables


def test_targets_and_spreads_are_those_of_the_inner_nodes() -> None:
    network: Node = {"kind": "network", "biases": [np.zeros(4), np.zeros(3)], "factor": np.eye(5)}
    inner: Node = {"kind": "mean", "members": [network, network]}
    node: Node = {"kind": "standardised", "inner": inner}
    assert n_targets(node) == 3
    assert has_spread(node)
    assert not has_spread({"kind": "mean", "members": [network, {"kind": "network"}]})


def test_inner_functions_stand_before_those_that_call_them() -> None:
    ones, tables = np.ones(1), Tables("arm")
    line: Node = {"kind": "polynomial", "factors": np.zeros((1, 1), int), "n_features": 1, "mean": ones, "scale": ones}
    line |= {"weights": np.ones((1, 1)), "constant": ones}
    assert c_function({"kind": "standardised", "mean": ones, "scale": ones, "inner": line}, tables) == "arm_f1"
    assert "softkin_polynomial" in tables.functions[0]
    assert "arm_f0(z, y, s);" in tables.functions[1]
