"""What every claim of the registry must do: its rule can give either verdict, and says what is missing."""

from __future__ import annotations

import pytest

from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import DOES_NOT, HOLDS, NOT_ASSESSABLE, judged
from softkin.reporting.claims.table import numbers_text
from tests.unit.reporting.claims.worlds import world

#: No run decides them.
JUDGEMENTS = {"models_lack_interpretability", "table_1_interpretability"}
#: Claims that contradict others of the paper: errors with which they hold, and with which they do not.
OF_THEIR_OWN = {
    "linear_competitive_on_abaqus": ("wrong", "right"),
    "table_1_predictive_power": ("graded", "right"),
}


def worlds_of(name: str) -> tuple[Measured, Measured]:
    right, wrong = OF_THEIR_OWN.get(name, ("right", "wrong"))
    return world(True, right), world(False, wrong)


@pytest.mark.parametrize("name", CLAIMS)
def test_a_claim_is_named_and_says_where_it_stands(name: str) -> None:
    claim = CLAIMS[name]
    assert claim.name == name
    for text in (claim.text, claim.where, claim.rule_text, claim.missing):
        assert text
        assert not text.endswith(".")
    assert bool(claim.table) != (name in JUDGEMENTS)


@pytest.mark.parametrize("name", [name for name in CLAIMS if name not in JUDGEMENTS])
def test_a_rule_gives_either_verdict_with_numbers(name: str) -> None:
    claim, (right, wrong) = CLAIMS[name], worlds_of(name)
    holds, fails = judged(claim, right), judged(claim, wrong)
    assert (holds.verdict, fails.verdict) == (HOLDS, DOES_NOT), (numbers_text(claim, holds), numbers_text(claim, fails))
    assert fails.settings == ()
    for verdict in (holds, fails):
        assert all(case.setting and case.place and case.number for case in verdict.cases)


@pytest.mark.parametrize("name", CLAIMS)
def test_of_a_run_with_rows_left_out_nothing_is_said(name: str) -> None:
    """As in the configuration of the tests."""
    claim = CLAIMS[name]
    verdict = judged(claim, world(True, is_cut=True))
    assert verdict.verdict == NOT_ASSESSABLE
    assert numbers_text(claim, verdict) == f"it would take {claim.missing}"


@pytest.mark.parametrize("name", JUDGEMENTS)
def test_a_judgement_is_not_assessable(name: str) -> None:
    for measured in worlds_of(name):
        assert judged(CLAIMS[name], measured).verdict == NOT_ASSESSABLE
