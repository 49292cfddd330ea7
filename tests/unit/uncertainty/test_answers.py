from __future__ import annotations

import numpy as np
import pandas as pd

from softkin.uncertainty.answers import bounds_frame, like

TABLE = pd.DataFrame({"u1": [1.0, 2.0]}, index=["a", "b"])
BOUNDS = np.arange(8.0).reshape(2, 2, 1, 2)


def test_an_answer_has_the_form_of_the_call() -> None:
    values = np.array([[1.0], [2.0]])
    assert like([1.0], values, ["m1_x"]) is values
    pd.testing.assert_frame_equal(like(TABLE, values, ["m1_x"]), pd.DataFrame({"m1_x": [1.0, 2.0]}, index=["a", "b"]))
    assert like(TABLE, values[:, 0], "pose").name == "pose"
    assert list(like(TABLE.iloc[0], values[:1], ["m1_x"]).index) == ["a"]


def test_bounds_of_several_levels_lie_below_each() -> None:
    many = bounds_frame(TABLE, BOUNDS, [0.9, 0.8], ["m1_x"])
    assert list(many.columns) == [(level, side) for level in (0.9, 0.8) for side in ("lower_m1_x", "upper_m1_x")]
    pd.testing.assert_frame_equal(many[0.8], bounds_frame(TABLE, BOUNDS[1:], None, ["m1_x"]))


def test_a_level_asked_twice_is_answered_twice() -> None:
    twice = bounds_frame(TABLE, BOUNDS, [0.9, 0.9], ["m1_x"])
    assert list(twice.columns.get_level_values(0)) == [0.9] * 4
    np.testing.assert_array_equal(twice.to_numpy()[:, 2:], BOUNDS[1].reshape(2, 2))
