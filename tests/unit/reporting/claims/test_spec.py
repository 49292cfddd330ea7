from __future__ import annotations

from dataclasses import replace

import pytest

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import DOES_NOT, HOLDS, HOLDS_WITH, NOT_ASSESSABLE, Case, judged
from tests.unit.reporting.claims.worlds import world

WORLD = world(True)
CLAIM = CLAIMS["ensembles_most_robust"]


def case(setting: str, place: str, holds: bool) -> Case:
    return Case(setting, place, holds, "1")


@pytest.mark.parametrize(
    ("most", "paper", "tuned", "verdict", "settings"),
    [
        (False, [True, True], [True, True], HOLDS, ("paper", "tuned")),
        (False, [True, True], [True, False], HOLDS_WITH, ("paper",)),
        (False, [True, False], [True, False], DOES_NOT, ()),
        (True, [True, True, False], [True, False, False], HOLDS_WITH, ("paper",)),
        (True, [True, False], [False, False], DOES_NOT, ()),
    ],
)
def test_it_holds_with_the_settings_whose_cases_hold(
    most: bool, paper: list[bool], tuned: list[bool], verdict: str, settings: tuple[str, ...]
) -> None:
    cases = [
        case(setting, f"arm{i} test", holds)
        for setting, votes in (("paper", paper), ("tuned", tuned))
        for i, holds in enumerate(votes)
    ]
    found = judged(replace(CLAIM, rule=lambda _: cases, most=most, robots=2), WORLD)
    assert (found.verdict, found.settings) == (verdict, settings)


def test_cases_of_too_few_robots_decide_nothing() -> None:
    cases = [case("paper", "arm test", True), case("paper", "arm extrapolation", True)]
    assert judged(replace(CLAIM, rule=lambda _: cases, robots=2), WORLD).verdict == NOT_ASSESSABLE
    assert judged(replace(CLAIM, rule=lambda _: cases, robots=1), WORLD).verdict == HOLDS
