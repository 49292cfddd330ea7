"""Claims on how models were set, and the printed cells that tell with which settings."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median

from softkin.core.runs import PAPER, SEARCHED
from softkin.core.samples import TEST
from softkin.models.paper_groups import ALL
from softkin.reporting.claims.comparing import MISSING_MODELS, POINTS
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec
from softkin.reporting.tables.numbers import number_text
from softkin.reporting.tables.verdicts import REPRODUCED

#: At a setting near its optimum, an error is at most this factor above the one that a search finds.
FACTOR = 1.1
#: The share of printed cells that shows that the settings of the preset are those of the paper.
MOST_CELLS = 0.9


def _near_optimal(measured: Measured) -> Iterator[Case]:
    for place in measured.places([TEST]):
        paper = measured.errors(place, PAPER, ALL)
        searched = [errors for preset in SEARCHED if (errors := measured.errors(place, preset, ALL))]
        if paper and searched:
            factors = {model: paper[model] / min(errors[model] for errors in searched) for model in ALL}
            typical = median(factors.values())
            number = f"median x {number_text(typical)}, {sum(f > FACTOR for f in factors.values())} of {len(factors)}"
            yield Case(PAPER, " ".join(place), typical <= FACTOR, number)


def _printed_cells(measured: Measured) -> Iterator[Case]:
    cells = measured.frames["published_comparison"]
    if f"{PAPER}_verdict" not in cells or set(cells["dataset"]) - set(measured.datasets):
        return
    for dataset, of_dataset in cells.groupby("dataset", sort=False):
        n_same = int((of_dataset[f"{PAPER}_verdict"] == REPRODUCED).sum())
        yield Case(PAPER, str(dataset), n_same >= MOST_CELLS * len(of_dataset), f"{n_same} of {len(of_dataset)}")


NEAR_OPTIMAL = ClaimSpec(
    name="settings_near_optimal",
    text="hyperparameters were manually tuned for near-optimal performance",
    where="section 4, metrics",
    rule=_near_optimal,
    rule_text=f"RMSE on test, paper's settings over searched ones: median of the eight at most {FACTOR}",
    table=POINTS,
    missing=f"{MISSING_MODELS}, with the paper's settings and searched",
    robots=3,
)
PRINTED_CELLS = ClaimSpec(
    name="printed_cells",
    text="RMSE, MAE, R2 and MAPE of eight models are as printed in Tables 3 to 5",
    where="tables 3 to 5",
    rule=_printed_cells,
    rule_text=f"at least {100 * MOST_CELLS:.0f} % of the cells of each table within one unit of the last printed digit",
    table="published_comparison.csv",
    missing="the paper's settings on its three datasets, complete",
    robots=3,
)
