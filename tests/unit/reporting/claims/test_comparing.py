from __future__ import annotations

from softkin.reporting.claims.comparing import against, best, least, middle, of_errors, of_growth, ranks
from tests.unit.reporting.claims.worlds import BOOSTED, RIGHT, world

WORLD = world(True)


def test_equal_errors_share_their_rank() -> None:
    assert ranks({"a": 1.0, "b": 3.0, "c": 3.0, "d": 9.0}) == {"a": 1, "b": 2.5, "c": 2.5, "d": 4}


def test_errors_of_some_models() -> None:
    assert best(RIGHT) == "gb"
    assert least(RIGHT, ["svr", "gp"]) == 2.0
    assert middle(RIGHT, ["svr", "gp", "rf"]) == 3.0
    assert against("one", 1.234, "other", 2.0) == "one 1.23, other 2.00"


def test_there_is_a_case_per_preset_and_place() -> None:
    cases = list(of_errors(WORLD, lambda errors: (errors["gb"] == 1.0, "1"), datasets=["finger"]))
    assert [(case.setting, case.place, case.holds) for case in cases[:2]] == [
        ("paper", "finger test", True),
        ("paper", "finger extrapolation", False),
    ]
    assert len(cases) == 6


def test_growth_is_the_error_in_extrapolation_over_that_on_test() -> None:
    [case, *_] = of_growth(WORLD, lambda growth: (growth == {"gb": 1.5, "xgb": 1.5}, "1"), models=BOOSTED)
    assert case.holds
    assert case.place == "abaqus"
