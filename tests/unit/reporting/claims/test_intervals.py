from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_promises_are_kept_or_not_by_setting() -> None:
    found = numbers("coverage_guaranteed", False)
    assert found["in-domain", "finger test"] == "50.0 %, 0 of 3 coordinates as said"
    assert found["in a new session", "finger_recorded 2 after 1, memory play"] == "30.0 %"
    assert numbers("whole_positions_covered", True)["coordinate by coordinate", "finger test"] == "93.0 % of poses"


def test_methods_stand_beside_each_other() -> None:
    place = ("around gb paper", "finger test")
    assert numbers("scp_best_coverage", True)[place] == "qr 75.0 %, cqr 88.0 %, scp_mapie 93.0 %"
    assert numbers("scp_best_winkler", True)[place] == "qr 10.0, cqr 9.00, scp_mapie 5.00"
    assert numbers("scp_narrower", True)[place] == "4.00 for 8.00 mm"
    assert numbers("cqr_outperforms_qr", True)[place] == "off the level by 2.0 % for 15.0 %, 9.00 for 10.0 mm"
    assert numbers("mapie_better_than_crepes", False)[place] == "the same"
    assert numbers("mapie_better_than_crepes", False)["as printed", "finger"] == "Winkler 0.59 and 0.5 mm"


def test_one_robot_is_enough_for_what_may_be() -> None:
    assert len(numbers("qr_not_calibrated", True)) == 2
