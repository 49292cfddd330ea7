from __future__ import annotations

import json

import numpy as np

from softkin.uncertainty.export.face import decoded, encoded


def test_numbers_come_back_to_the_bit() -> None:
    node = {"a": np.array([[0.1, np.inf]]), "b": [np.arange(3), None, True], "c": np.float64(0.1), "d": {"e": "text"}}
    back = decoded(json.loads(json.dumps(encoded(node))))
    np.testing.assert_array_equal(back["a"], node["a"])
    np.testing.assert_array_equal(back["b"][0], [0, 1, 2])
    assert back["b"][1:] == [None, True]
    assert back["c"] == 0.1
    assert back["d"] == {"e": "text"}
