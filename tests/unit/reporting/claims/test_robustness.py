from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_the_numbers_are_the_best_model_and_how_errors_grow() -> None:
    assert numbers("ensembles_most_robust", True)["paper", "finger extrapolation"] == "gb 1.50"
    assert numbers("all_degrade_in_extrapolation", False)["tuned", "finger"] == "2 of 8, least lr x 0.900"
    assert numbers("boosting_robust_to_drift", True)["paper", "finger"] == "x 1.50, others x 2.00"
    assert numbers("kernels_degrade_by_drift", True)["paper", "finger"] == "svr x 2.00, gp x 2.00"
    assert numbers("ensembles_best_candidates", False)["for both", "finger"] == "lr"
