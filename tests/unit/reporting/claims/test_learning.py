from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_growth_of_the_network_stands_beside_that_of_the_others() -> None:
    assert numbers("network_needs_data", True)["paper", "finger"] == "x 5.00, others x 2.00"
    assert numbers("network_needs_data", False)["tuned", "finger"] == "x 1.50, others x 2.00"
