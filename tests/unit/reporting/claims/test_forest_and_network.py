from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_only_searched_settings_tell_what_a_forest_lacks() -> None:
    assert {setting for setting, _ in numbers("forest_lacks_regularization", True)} == {"tuned", "outer"}
    assert numbers("forest_much_worse", True)["paper", "finger test"] == "x 8.00"


def test_the_network_has_a_rank() -> None:
    assert numbers("network_moderate", True)["paper", "finger test"] == "rank 5"
    assert numbers("network_moderate", False)["paper", "finger test"] == "rank 1"
