from __future__ import annotations

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.spec import judged
from tests.unit.reporting.claims.worlds import world


def numbers(name: str, is_right: bool) -> dict[tuple[str, str], str]:
    cases = judged(CLAIMS[name], world(is_right)).cases
    return {(case.setting, case.place): case.number for case in cases}


def test_pairs_in_the_wrong_order_are_counted() -> None:
    """The forest is the worst of the eight and has the highest grade: three models of lower grades stand before it."""
    number = numbers("table_1_predictive_power", True)["paper", "finger"]
    assert number.startswith("5 of 17 pairs in the wrong order; mean ranks lr 6.00, lasso 7.00, rf 8.00")
