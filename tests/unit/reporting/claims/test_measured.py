from __future__ import annotations

import pandas as pd

from softkin.reporting.claims.measured import Interval, Point, measured
from tests.unit.reporting.claims.worlds import DATASETS, RIGHT, card, descriptions, frames, world

RIGHT_WORLD, WRONG_WORLD = world(True), world(False)


def test_twins_leaks_and_few_commands_are_no_places() -> None:
    assert RIGHT_WORLD.robots() == list(DATASETS[:4])
    assert ("elastica", "test") in RIGHT_WORLD.places()
    assert ("elastica", "test") not in WRONG_WORLD.places()  # leaks
    cards = [card(name, True) for name in DATASETS]
    cards[3]["checks"]["few_commands"]["distinct"]["extrapolation"] = 12
    places = measured(frames(True, RIGHT), descriptions(True), cards).places()
    assert ("finger", "extrapolation") not in places
    assert ("finger", "test") in places


def test_stand_ins_and_cut_datasets_say_nothing() -> None:
    about = descriptions(True)
    about[0]["origin"], about[1]["is_cut"] = "stand-in", True
    found = measured(frames(True, RIGHT), about, [card(name, True) for name in DATASETS])
    assert found.datasets == DATASETS[2:]


def test_coordinates_are_counted_that_are_covered_as_said() -> None:
    """By their adjusted p-value where coverage is promised, else by whether chance explains the level."""
    key = ("finger", "test", "gb", "paper")
    assert RIGHT_WORLD.bands[(*key, "scp_mapie")] == (3, 3)
    assert WRONG_WORLD.bands[(*key, "scp_mapie")] == (0, 3)
    assert RIGHT_WORLD.bands[(*key, "qr")] == (0, 3)
    assert RIGHT_WORLD.joint[(*key, "scp_mapie")] == (0.93, True)
    about = descriptions(True)
    about[3]["constant_coordinates"] = ["m1_z"]
    found = measured(frames(True, RIGHT), about, [card(name, True) for name in DATASETS])
    assert found.bands[(*key, "scp_mapie")] == (2, 2)


def test_a_model_that_was_not_run_has_no_errors() -> None:
    place = ("finger", "test")
    assert RIGHT_WORLD.errors(place, "paper", ["gb", "svr"]) == {"gb": 1.0, "svr": 2.0}
    assert RIGHT_WORLD.errors(place, "paper", ["gb", "unknown"]) == {}


def test_a_row_left_out_changes_what_was_measured_of_its_subset_alone() -> None:
    row = {"dataset": "finger", "subset": "test", "left_out": "row 3", "model": "gb", "preset": "paper", "value": 1.0}
    rows = [
        row | {"interval_method": "", "metric": "rmse_mm", "without": 0.5},
        row | {"interval_method": "scp_mapie", "metric": "winkler_mm", "without": 4.5},
    ]
    without = RIGHT_WORLD.without(pd.DataFrame(rows))
    point, interval = (
        Point("finger", "test", "gb", "paper"),
        Interval("finger", "test", "gb", "paper", "scp_mapie", "winkler_mm"),
    )
    assert (without.points[point], RIGHT_WORLD.points[point]) == (0.5, 1.0)
    assert (without.intervals[interval], RIGHT_WORLD.intervals[interval]) == (4.5, 5.0)
    changed = {key for key, value in without.points.items() if value != RIGHT_WORLD.points[key]}
    assert changed == {point}
