from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_sizes_leaks_and_drift() -> None:
    assert numbers("sizes", True)["as printed", "finger"] == "4 of 4 subsets"
    assert numbers("testing_is_held_out", False)["as published", "elastica"] == "leak: test"
    assert numbers("extrapolation_drifts", False)["as published", "finger"] == (
        "AUC validation 0.50, test 0.90, extrapolation 0.95"
    )
