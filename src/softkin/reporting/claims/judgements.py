"""Claims that no run can decide, and why."""

from __future__ import annotations

from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec


def _undecided(_measured: Measured) -> list[Case]:
    return []


LACK_INTERPRETABILITY = ClaimSpec(
    name="models_lack_interpretability",
    text="machine learning models lack interpretability, which has made uncertainty quantification difficult",
    where="section 1",
    rule=_undecided,
    rule_text="none: the paper defines no measure of interpretability",
    table="",
    missing="a definition: interpretability is a judgement, and split conformal prediction needs none",
)
INTERPRETABILITY = ClaimSpec(
    name="table_1_interpretability",
    text="interpretability is high for linear models, medium for kernels, low for ensembles and networks",
    where="section 3; table 1",
    rule=_undecided,
    rule_text="none: the paper defines no measure of interpretability",
    table="",
    missing="a definition: interpretability is a judgement, and its grades cannot be measured",
)
