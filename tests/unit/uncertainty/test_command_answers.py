from __future__ import annotations

import numpy as np
import pandas as pd

from softkin.uncertainty.command_answers import CommandAnswers


def test_a_table_has_the_columns_of_one_marker_and_of_a_probability_where_there_is_one() -> None:
    sides = np.array([[[-1.0, 1.0], [-2.0, 2.0], [-3.0, 3.0]]])
    told = np.array([[0.5, 0.25]]), np.array([[7.0, 8.0, 9.0]]), sides, np.array([0.5]), np.array([2.0])
    answers = CommandAnswers(*told, np.array([0.75]), np.array(["nearest"]))
    table = answers.table(["left", "right"], 1, pd.Index([4]))
    first = ["left", "right", "m2_x", "lower_m2_x", "upper_m2_x"]
    assert [*table.columns[:5]] == first
    assert [*table.columns[-4:]] == ["residual_mm", "within_mm", "probability", "verdict"]
    assert table.loc[4, first].tolist() == [0.5, 0.25, 7.0, -1.0, 1.0]
    without = CommandAnswers(*told, None, np.array(["nearest"])).table(["left", "right"], 0, pd.Index([4]))
    assert "probability" not in without
    assert "upper_m1_z" in without
