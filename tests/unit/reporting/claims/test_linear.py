from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_linear_models_stand_beside_the_best() -> None:
    assert numbers("linear_competitive_on_abaqus", True)["paper", "abaqus test"] == "lr and gp 4.00, gb or xgb 1.00"
    assert set(numbers("linear_and_gp_poor_on_finger", True)) == {
        (preset, f"finger {subset}") for preset in ("paper", "tuned", "outer") for subset in ("test", "extrapolation")
    }
    assert numbers("linear_rank_worst", False)["tuned", "finger test"] == "ensemble, linear 3.50 of 7.00"
    assert numbers("lasso_worst", True)["paper", "finger test"] == "lr 4.00, lasso 5.00"


def test_of_elastica_the_revision_that_does_not_leak_speaks() -> None:
    places = {place for _, place in numbers("boosting_outshines_on_elastica", False)}
    assert places == {"elastica_2023_09 test"}
