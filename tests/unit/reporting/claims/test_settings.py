from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_settings_are_held_against_searched_ones() -> None:
    assert numbers("settings_near_optimal", True)["paper", "finger test"] == "median x 1.00, 0 of 8"
    assert numbers("settings_near_optimal", False)["paper", "finger test"] == "median x 3.00, 8 of 8"
    assert numbers("printed_cells", True)["paper", "finger"] == "1 of 1"
