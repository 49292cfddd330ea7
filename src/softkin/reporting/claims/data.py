"""Claims on the datasets: their sizes, and how their subsets differ."""

from __future__ import annotations

from collections.abc import Iterator

from softkin.core.samples import EXTRAPOLATION, TEST, VALIDATION
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec

DATA = "section 4, dataset"
#: An AUC of one half is that of two samples of one distribution.
CHANCE = 0.5
#: Where a classifier that tells extrapolation from train is this many times as far from chance as one that tells test.
MUCH_MORE = 3.0


def _sizes(measured: Measured) -> Iterator[Case]:
    printed = measured.frames["subsets"]
    for dataset, rows in printed.groupby("dataset", sort=False):
        if dataset not in measured.datasets:
            continue
        about = measured.descriptions[str(dataset)]
        n_right = sum(
            about["rows"][row.subset] == row.n_rows
            and about["n_commands"] == row.n_commands
            and 3 * about["n_markers"] == row.n_coordinates
            for row in rows.itertuples()
        )
        yield Case("as printed", str(dataset), n_right == len(rows), f"{n_right} of {len(rows)} subsets")


def _held_out(measured: Measured) -> Iterator[Case]:
    for dataset in measured.frames["subsets"]["dataset"].unique():
        if dataset in measured.datasets:
            leaks = [subset for subset in (TEST, VALIDATION) if (dataset, subset) in measured.leaks]
            yield Case(
                "as published", str(dataset), not leaks, "no leak" if not leaks else f"leak: {' and '.join(leaks)}"
            )


def _drift(measured: Measured) -> Iterator[Case]:
    for dataset in measured.robots():
        shift = measured.cards[dataset]["checks"].get("subset_shift", {})
        auc = {subset: shift.get(subset, {}).get("auc") for subset in (VALIDATION, TEST, EXTRAPOLATION)}
        if None not in auc.values():
            off = {subset: abs(value - CHANCE) for subset, value in auc.items()}
            near = max(off[VALIDATION], off[TEST])
            text = ", ".join(f"{subset} {value:.2f}" for subset, value in auc.items())
            yield Case("as published", dataset, off[EXTRAPOLATION] > MUCH_MORE * near, f"AUC {text}")


SIZES = ClaimSpec(
    name="sizes",
    text="sizes of the subsets, numbers of commands and coordinates are as in Table 2",
    where=f"{DATA}; table 2",
    rule=_sizes,
    rule_text="rows, commands and coordinates of every subset equal the printed ones",
    table="paper_tables.md",
    missing="the paper's three datasets, complete",
    robots=3,
)
HELD_OUT = ClaimSpec(
    name="testing_is_held_out",
    text="testing data are held out, so that scores on them show the generalization of trained models",
    where=f"{DATA}; tables 3 to 6",
    rule=_held_out,
    rule_text="no command of test or validation stands in train, on each of the paper's datasets",
    table="point_metrics.csv",
    missing="the paper's three datasets, complete",
    robots=3,
)
DRIFT = ClaimSpec(
    name="extrapolation_drifts",
    text="train is distributed much more like validation and test than like extrapolation, on all datasets",
    where=f"{DATA}; figure 3",
    rule=_drift,
    rule_text=f"AUC of a classifier that tells a subset from train: extrapolation more than {MUCH_MORE:g} times as "
    "far from one half as validation and test, on each robot",
    table="data_card.json of each dataset",
    missing="data cards of complete published robots",
    robots=3,
)
