"""Claims on generalization: which models keep their errors small on new commands, and beyond those of train."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from softkin.models.paper_groups import ALL, BOOSTED, CATEGORIES, KERNEL
from softkin.reporting.claims.comparing import MISSING_MODELS, POINTS, SECTION, best, middle, of_errors, of_growth
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec
from softkin.reporting.tables.numbers import number_text

OTHERS = tuple(model for model in ALL if model not in BOOSTED)


def _most_robust(errors: dict[str, float]) -> tuple[bool, str]:
    winner = best(errors)
    return winner in BOOSTED, f"{winner} {number_text(errors[winner])}"


def _all_degrade(growth: dict[str, float]) -> tuple[bool, str]:
    least_of_all = best(growth)
    n_worse = sum(ratio > 1 for ratio in growth.values())
    text = f"{n_worse} of {len(growth)}, least {least_of_all} x {number_text(growth[least_of_all])}"
    return n_worse == len(growth), text


def _boosted_keep_better(growth: dict[str, float]) -> tuple[bool, str]:
    boosted, others = middle(growth, BOOSTED), middle(growth, OTHERS)
    return boosted < others, f"x {number_text(boosted)}, others x {number_text(others)}"


def _kernels_degrade(growth: dict[str, float]) -> tuple[bool, str]:
    text = ", ".join(f"{model} x {number_text(growth[model])}" for model in KERNEL)
    return all(growth[model] > 1 for model in KERNEL), text


def _best_candidates(measured: Measured) -> Iterator[Case]:
    """The first of the pool that softkin ranks by scores on `train` alone, for each objective."""
    selection = measured.frames.get("selection")
    if selection is None:
        return
    for row in selection.itertuples():
        if row.dataset in measured.robots() and set(ALL) <= set(str(row.pool).split()):
            yield Case(f"for {row.objective}", str(row.dataset), row.model in CATEGORIES["ensemble"], str(row.model))


MOST_ROBUST = ClaimSpec(
    name="ensembles_most_robust",
    text="nonlinear ensemble methods (GB, XGB) exhibit the most robust generalization performance",
    where=f"abstract; {SECTION}",
    rule=partial(of_errors, compare=_most_robust),
    rule_text="the smallest RMSE of the eight models is that of GB or XGB, in most places (test and extrapolation)",
    table=POINTS,
    missing=MISSING_MODELS,
    most=True,
    robots=3,
)
ALL_DEGRADE = ClaimSpec(
    name="all_degrade_in_extrapolation",
    text="the performance of all models degrades on extrapolation data",
    where=SECTION,
    rule=partial(of_growth, compare=_all_degrade),
    rule_text="RMSE in extrapolation over RMSE on test is above 1 for each of the eight models on each robot",
    table=POINTS,
    missing=MISSING_MODELS,
    robots=3,
)
BOOSTED_KEEP_BETTER = ClaimSpec(
    name="boosting_robust_to_drift",
    text="GB and XGB remain more robust against distribution drifts in general",
    where=f"{SECTION}; conclusions",
    rule=partial(of_growth, compare=_boosted_keep_better),
    rule_text="median growth of the RMSE from test to extrapolation: GB and XGB below the six others, on most robots",
    table=POINTS,
    missing=MISSING_MODELS,
    most=True,
    robots=3,
)
KERNELS_DEGRADE = ClaimSpec(
    name="kernels_degrade_by_drift",
    text="kernel methods (SVR, GP) degrade from testing to extrapolation data owing to the distribution drift",
    where=SECTION,
    rule=partial(of_growth, compare=_kernels_degrade, models=KERNEL),
    rule_text="RMSE in extrapolation over RMSE on test is above 1 for SVR and for GP, on each robot",
    table=POINTS,
    missing="SVR and GP on complete published robots",
    robots=3,
)
BEST_CANDIDATES = ClaimSpec(
    name="ensembles_best_candidates",
    text="ensemble methods like GB and XGB are the best model candidates for kinematic modeling in soft robots",
    where=f"{SECTION}, summary",
    rule=_best_candidates,
    rule_text="what cross-validation and outer shells of train rank first is RF, GB or XGB, on most robots",
    table="selection.csv",
    missing="a search over the paper's eight models on complete published robots",
    most=True,
    robots=3,
)
