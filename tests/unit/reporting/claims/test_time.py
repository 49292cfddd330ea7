from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_a_robot_that_remembers_refutes_the_claim_with_numbers() -> None:
    [number] = numbers("time_independent", False).values()
    for part in ("at 0.63 in m1_y", "at 0.42", "up to 3.5 mm", "from 1.27 to 0.53 mm", "as little as 30%"):
        assert part in number
