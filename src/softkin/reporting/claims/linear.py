"""Claims on linear models and on boosted trees beside them."""

from __future__ import annotations

from functools import partial
from statistics import fmean

from softkin.core.samples import TEST
from softkin.models.paper_groups import BOOSTED, CATEGORIES, LINEAR, PENALISED, PLAIN_LINEAR, PROCESS
from softkin.reporting.claims.comparing import (
    MISSING_MODELS,
    OF_A_SIZE,
    POINTS,
    SECTION,
    against,
    best,
    least,
    of_errors,
    ranks,
)
from softkin.reporting.claims.spec import ClaimSpec
from softkin.reporting.tables.numbers import number_text

ABAQUS, FINGER = ("abaqus",), ("finger",)
#: Both revisions of the simulated finger: where one leaks, the other speaks.
ELASTICA = ("elastica", "elastica_2023_09")


def _competitive(errors: dict[str, float]) -> tuple[bool, str]:
    linear, boosted = max(errors[PLAIN_LINEAR], errors[PROCESS]), least(errors, BOOSTED)
    return linear <= OF_A_SIZE * boosted, against("lr and gp", linear, "gb or xgb", boosted)


def _poor(errors: dict[str, float]) -> tuple[bool, str]:
    linear, boosted = min(errors[PLAIN_LINEAR], errors[PROCESS]), least(errors, BOOSTED)
    return linear >= OF_A_SIZE * boosted, against("lr and gp", linear, "gb or xgb", boosted)


def _outshine(errors: dict[str, float]) -> tuple[bool, str]:
    return best(errors) in BOOSTED, against("gb or xgb", least(errors, BOOSTED), best(errors), min(errors.values()))


def _linear_worst(errors: dict[str, float]) -> tuple[bool, str]:
    order = ranks(errors)
    means = {name: fmean(order[model] for model in models) for name, models in CATEGORIES.items()}
    worst = max(means, key=means.__getitem__)
    return worst == "linear", f"{worst}, linear {number_text(means['linear'])} of {number_text(means[worst])}"


def _linear_fail(errors: dict[str, float]) -> tuple[bool, str]:
    linear, winner = least(errors, LINEAR), best(errors)
    return linear >= OF_A_SIZE * errors[winner], against("lr and lasso", linear, winner, errors[winner])


def _penalised_worst(errors: dict[str, float]) -> tuple[bool, str]:
    pair = {model: errors[model] for model in LINEAR}
    return pair[PENALISED] > pair[PLAIN_LINEAR], ", ".join(f"{m} {number_text(e)}" for m, e in pair.items())


COMPETITIVE = ClaimSpec(
    name="linear_competitive_on_abaqus",
    text="LR and GP are notably competitive to GB and XGB for ABAQUS",
    where=SECTION,
    rule=partial(of_errors, compare=_competitive, datasets=ABAQUS),
    rule_text=f"RMSE of LR and of GP at most {OF_A_SIZE} times the smaller one of GB and XGB, on both subsets",
    table=POINTS,
    missing="the paper's eight models on ABAQUS, complete",
)
POOR = ClaimSpec(
    name="linear_and_gp_poor_on_finger",
    text="LR and GP perform poorly for the real-world data FINGER, particularly on the extrapolation data",
    where=SECTION,
    rule=partial(of_errors, compare=_poor, datasets=FINGER),
    rule_text=f"RMSE of LR and of GP at least {OF_A_SIZE} times the smaller one of GB and XGB, on both subsets",
    table=POINTS,
    missing="the paper's eight models on FINGER, complete",
)
OUTSHINE = ClaimSpec(
    name="boosting_outshines_on_elastica",
    text="GB and XGB outshine other models on the testing data of ELASTICA, by regularization and generalization",
    where=SECTION,
    rule=partial(of_errors, compare=_outshine, subsets=[TEST], datasets=ELASTICA),
    rule_text="the smallest RMSE of the eight on test is that of GB or XGB, in a revision whose test does not leak",
    table=POINTS,
    missing="the paper's eight models on a revision of ELASTICA whose test does not leak, complete",
)
RANK_WORST = ClaimSpec(
    name="linear_rank_worst",
    text="of the categories, linear models rank the worst",
    where=SECTION,
    rule=partial(of_errors, compare=_linear_worst),
    rule_text="mean rank by RMSE: the category linear has the worst one, in most places",
    table=POINTS,
    missing=MISSING_MODELS,
    most=True,
    robots=3,
)
FAIL = ClaimSpec(
    name="linear_fail_on_finger",
    text="LR and LASSO fail to learn the relationship between commands and positions of FINGER",
    where=SECTION,
    rule=partial(of_errors, compare=_linear_fail, datasets=FINGER),
    rule_text=f"RMSE of LR and of LASSO at least {OF_A_SIZE} times the smallest of the eight, on both subsets",
    table=POINTS,
    missing="the paper's eight models on FINGER, complete",
)
PENALTY = ClaimSpec(
    name="lasso_worst",
    text="LASSO performs the worst, because its penalty forces coefficients to zero",
    where=SECTION,
    rule=partial(of_errors, compare=_penalised_worst, models=LINEAR),
    rule_text="RMSE of LASSO above that of LR, the same model without the penalty, in most places",
    table=POINTS,
    missing="LR and LASSO on complete published robots",
    most=True,
    robots=3,
)
