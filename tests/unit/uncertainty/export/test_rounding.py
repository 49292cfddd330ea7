from __future__ import annotations

from dataclasses import replace

import pytest

from softkin.core.samples import Array
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.export.c_header import c_header
from softkin.uncertainty.export.python_file import python_file
from softkin.uncertainty.export.rounding import known_to, rounding
from tests.exported_robots import small


def test_nothing_is_said_of_a_model_that_answers_one_row_as_many() -> None:
    assert rounding(small("ridge")) < 1e-12
    assert known_to(small("ridge")) == ""
    assert "Known to" not in c_header(small("ridge"), name="arm")


def test_a_model_that_rounds_says_how_far(monkeypatch: pytest.MonkeyPatch) -> None:
    predict = CalibratedModel._predicted

    def rounded(robot: CalibratedModel, inputs: Array) -> Array:
        return predict(robot, inputs) + 2e-7 * (len(inputs) > 1)

    monkeypatch.setattr(CalibratedModel, "_predicted", rounded)
    robot = replace(small("ridge"))
    assert rounding(robot) == pytest.approx(2e-7, rel=1e-6)
    assert known_to(robot).startswith("Known to 2e-07 mm: so far apart, by rounding,")
    assert "Known to 2e-07 mm" in python_file(robot, name="arm")
    assert "   Known to 2e-07 mm" in c_header(robot, name="arm")
