"""The claim that the network needs more data than other models."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median

from softkin.core.samples import TEST
from softkin.models.paper_groups import NETWORK
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec
from softkin.reporting.tables.numbers import number_text

#: The share of train that is small.
SMALL = 0.1


def _network_needs_data(measured: Measured) -> Iterator[Case]:
    """How many times as large errors are on a tenth of train: of the network, and the median of the others."""
    curves = measured.frames.get("learning_curve")
    if curves is None:
        return
    for (preset, dataset), of_run in curves.groupby(["preset", "dataset"], sort=False):
        wide = of_run.pivot_table(index="model", columns="share", values="mae_mm", dropna=False)
        is_complete = {SMALL, 1.0} <= set(wide.columns) and NETWORK in wide.index
        if (dataset, TEST) not in measured.places() or not is_complete:
            continue
        growth = (wide[SMALL] / wide[1.0]).to_dict()
        own = growth.pop(NETWORK)
        if growth:
            others = median(growth.values())
            yield Case(str(preset), str(dataset), own > others, f"x {number_text(own)}, others x {number_text(others)}")


NETWORK_NEEDS_DATA = ClaimSpec(
    name="network_needs_data",
    text="MLP has more parameters than other models, thus requires a large amount of data",
    where="section 4, system identification",
    rule=_network_needs_data,
    rule_text=f"MAE on test after {SMALL:.0%} of train over that after all of it: MLP above the median of the other "
    "nonlinear models, on each robot",
    table="learning_curve.csv",
    missing="learning curves of MLP and other models on complete published robots",
    robots=3,
)
