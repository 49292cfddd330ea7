"""Lay out our intervals for a paper: per robot, every method around the chosen, the deployed and the paper's run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pandas as pd

from softkin.core.samples import TEST
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.tables.interval_choice import chosen_intervals, deployed_intervals, why_another_is_deployed
from softkin.reporting.tables.numbers import number_text, share_text
from softkin.reporting.tables.paper_layout import PaperTable
from softkin.reporting.titles import Titles
from softkin.reporting.units import heading_of, told, units_in
from softkin.uncertainty.intervals.spec import MARGINAL
from softkin.uncertainty.promise import BY_BLOCK

#: Guarantees among whose methods the best is bold.
GUARANTEED = (MARGINAL, BY_BLOCK)
HEADER = ("Method", "Around", "Guarantee", "Coverage (%)", "Mean width ({unit})", "Winkler score ({unit})")
RUN = ["model", "preset"]


def interval_table(
    metrics: pd.DataFrame,
    choice: pd.DataFrame,
    dataset_titles: Mapping[str, str],
    titles: Titles,
    notes: Sequence[str] = (),
) -> PaperTable:
    """A group of rows per dataset, a row per method and run: at the level at which methods were compared, on `test`,
    averaged over the moving coordinates.

    The runs are that of the chosen interval, that of the deployed one, and the paper's. The chosen and the deployed
    interval are named as such, and the lowest Winkler score among methods with a guarantee is bold. A dataset whose
    scores leak (column `leak`) says so in its heading, as does one whose unit is not that of the others.

    Parameters:
        metrics: as in interval_metrics.csv.
        choice: as in interval_choice.csv.
        dataset_titles: dataset -> title; a group each.
        titles: of models and of the methods that are shown.
        notes: sentences below the table.
    """
    rows: list[list[str]] = []
    bold: set[tuple[int, int]] = set()
    groups = []
    unit, units = heading_of(choice), told(units_in(choice))
    for dataset, title in dataset_titles.items():
        chosen = chosen_intervals(choice).loc[dataset]
        deployed = deployed_intervals(choice).loc[dataset]
        shown = _shown(metrics[metrics["dataset"] == dataset], chosen, deployed, list(titles.methods))
        guaranteed = shown.loc[shown["guarantee"].isin(GUARANTEED), "winkler_mm"]
        for row in shown.to_dict("records"):
            if row["guarantee"] in GUARANTEED and row["winkler_mm"] == guaranteed.min():
                bold.add((len(rows), len(HEADER) - 1))
            words = [titles.methods[row["interval_method"]]]
            for word, best in (("chosen", chosen), ("deployed", deployed)):
                if best[word] and all(row[key] == best[key] for key in (*RUN, "interval_method")):
                    words.append(word)
            around = titles.run(row["model"], row["preset"])
            numbers = (number_text(row["mean_width_mm"]), number_text(row["winkler_mm"]))
            rows.append([", ".join(words), around, row["guarantee"], f"{100 * row['coverage']:.1f}", *numbers])
        said = [units[name] for name in (dataset,) if name in units] + ["LEAK"] * bool(shown["leak"].any())
        groups.append((f"{title} ({', '.join(said)})" if said else title, len(shown)))
    remark = (
        "Test rows, averaged over the moving coordinates; nominal level "
        f"{share_text(float(choice['confidence_level'].iloc[0]), 0)}. Chosen: the lowest typical Winkler score, "
        "cross-validated on validation rows. Deployed: what the calibrated model holds. Bold: the lowest Winkler "
        "score on test among the methods with a marginal guarantee."
    )
    reasons = [f"{dataset_titles[d]}: {why}" for d, why in why_another_is_deployed(choice, titles).items()]
    header = [name.format(unit=unit) for name in HEADER]
    return PaperTable("Prediction intervals, as measured", header, rows, bold, groups, [remark, *reasons, *notes])


def _shown(metrics: pd.DataFrame, chosen: pd.Series, deployed: pd.Series, methods: Sequence[str]) -> pd.DataFrame:
    """The rows of one dataset's `metrics` that are shown, in the order of `methods`, then of the runs."""
    means = metrics[
        (metrics["subset"] == TEST)
        & (metrics["coordinate"] == "mean_informative")
        & metrics["interval_method"].isin(methods)
        & (metrics["confidence_level"] == chosen["confidence_level"])
    ]
    runs = list(dict.fromkeys([*(tuple(best[RUN]) for best in (chosen, deployed)), PAPERS_RUN]))
    parts = [means[(means["model"] == model) & (means["preset"] == preset)] for model, preset in runs]
    shown = pd.concat([part.assign(order=part["interval_method"].map(list(methods).index)) for part in parts])
    return shown.sort_values("order", kind="stable")
