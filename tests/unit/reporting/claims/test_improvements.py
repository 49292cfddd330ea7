from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_printed_gains_are_those_of_one_column() -> None:
    assert numbers("scp_improvements", True)["as printed", "finger"] == (
        "said 27 %/73 %, scp_mapie 27 %/73 %, scp_crepes 12 %/30 %"
    )
    assert numbers("scp_improvements", True)["around gb paper", "finger test"] == "24 %/50 %"
