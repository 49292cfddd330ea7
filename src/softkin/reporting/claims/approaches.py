"""The claim of Table 1 on the predictive power of each approach."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import fmean

from softkin.reporting.claims.comparing import MISSING_MODELS, POINTS, ranks
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec
from softkin.reporting.tables.numbers import number_text

GRADES = ("High", "Medium", "Low")


def _predictive_power(measured: Measured) -> Iterator[Case]:
    """Per preset, of all places: the mean ranks of models of one grade against those of the next."""
    grades = measured.frames["approaches"].set_index("model")["predictive_power"].to_dict()
    for preset in measured.presets:
        found = [measured.errors(place, preset, grades) for place in measured.places()]
        if not all(found) or not found:
            continue
        orders = [ranks(errors) for errors in found]
        mean_rank = {model: fmean(order[model] for order in orders) for model in grades}
        pairs = [
            (better, worse)
            for better in grades
            for worse in grades
            if GRADES.index(grades[better]) < GRADES.index(grades[worse])
        ]
        wrong = [(better, worse) for better, worse in pairs if mean_rank[better] >= mean_rank[worse]]
        text = ", ".join(f"{model} {number_text(rank)}" for model, rank in mean_rank.items())
        for dataset in dict.fromkeys(dataset for dataset, _ in measured.places()):
            number = f"{len(wrong)} of {len(pairs)} pairs in the wrong order; mean ranks {text}"
            yield Case(preset, dataset, not wrong, number)


PREDICTIVE_POWER = ClaimSpec(
    name="table_1_predictive_power",
    text="predictive power is high for RF, GB, XGB, GP and MLP, medium for SVR, low for LR and LASSO",
    where="section 3; table 1",
    rule=_predictive_power,
    rule_text="mean rank by RMSE over all places: each model of a higher grade before each of a lower one",
    table=POINTS,
    missing=MISSING_MODELS,
    robots=3,
)
