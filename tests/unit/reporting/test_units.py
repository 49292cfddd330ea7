from __future__ import annotations

import pandas as pd

from softkin.reporting.units import heading_of, told, units_in, with_units

FRAMES = {"scores": pd.DataFrame({"dataset": ["arm", "cam"], "rmse_mm": [1.0, 2.0]}), "claims": pd.DataFrame()}
ARM, CAM = {"dataset": "arm"}, {"dataset": "cam", "unit": "px"}


def test_tables_of_robots_in_mm_stay_as_they_are() -> None:
    frames = with_units(FRAMES, [ARM, {"dataset": "cam"}])
    assert frames == FRAMES
    assert (units_in(FRAMES["scores"]), heading_of(FRAMES["scores"])) == ({"arm": "mm", "cam": "mm"}, "mm")
    assert told(units_in(FRAMES["scores"])) == {}


def test_a_robot_in_a_unit_of_its_own_names_it_in_each_row() -> None:
    frames = with_units(FRAMES, [ARM, CAM])
    assert frames["scores"]["unit"].tolist() == ["mm", "px"]
    assert list(frames["scores"].columns) == ["dataset", "rmse_mm", "unit"]
    assert frames["claims"].empty
    assert heading_of(frames["scores"]) == "mm or px"
    assert told(units_in(frames["scores"])) == {"cam": "in px"}


def test_where_all_have_one_unit_the_heading_says_it_all() -> None:
    scores = with_units({"scores": FRAMES["scores"].iloc[1:]}, [CAM])["scores"]
    assert heading_of(scores) == "px"
    assert told(units_in(scores)) == {}
