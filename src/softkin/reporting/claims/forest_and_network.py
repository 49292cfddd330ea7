"""Claims on the forest and on the network."""

from __future__ import annotations

from functools import partial

from softkin.core.runs import SEARCHED
from softkin.models.paper_groups import BOOSTED, FOREST, NETWORK
from softkin.reporting.claims.comparing import FAR_APART, MISSING_MODELS, POINTS, SECTION, least, of_errors, ranks
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec
from softkin.reporting.tables.numbers import number_text


def _forest_worse(errors: dict[str, float]) -> tuple[bool, str]:
    ratio = errors[FOREST] / least(errors, BOOSTED)
    return ratio >= FAR_APART, f"x {number_text(ratio)}"


def _forest_unregularised(measured: Measured) -> list[Case]:
    """Were it the want of regularization, which no setting of a forest adds, searched settings would not help."""
    return [case for case in FOREST_WORSE.rule(measured) if case.setting in SEARCHED]


def _network_moderate(errors: dict[str, float]) -> tuple[bool, str]:
    rank = ranks(errors)[NETWORK]
    return len(errors) / 3 < rank < 2 * len(errors) / 3 + 1, f"rank {rank:g}"


FOREST_WORSE = ClaimSpec(
    name="forest_much_worse",
    text="the performance of RF is much worse than that of GB and XGB across diverse data",
    where=SECTION,
    rule=partial(of_errors, compare=_forest_worse, models=(FOREST, *BOOSTED)),
    rule_text=f"RMSE of RF at least {FAR_APART:g} times the smaller one of GB and XGB, in most places",
    table=POINTS,
    missing="RF, GB and XGB on complete published robots",
    most=True,
    robots=3,
)
UNREGULARISED = ClaimSpec(
    name="forest_lacks_regularization",
    text="RF is worse due to its lack of regularization techniques",
    where=SECTION,
    rule=_forest_unregularised,
    rule_text=f"searched settings of RF, which cannot add what it lacks, do not help: its RMSE is still at least "
    f"{FAR_APART:g} times the smaller one of GB and XGB, in most places",
    table=POINTS,
    missing="RF, GB and XGB searched on complete published robots",
    most=True,
    robots=3,
)
MODERATE = ClaimSpec(
    name="network_moderate",
    text="MLP performs moderately across all methods",
    where=SECTION,
    rule=partial(of_errors, compare=_network_moderate),
    rule_text="rank of MLP by RMSE among the eight in the middle third, in most places",
    table=POINTS,
    missing=MISSING_MODELS,
    most=True,
    robots=3,
)
