"""Our intervals as tables that paste into a paper: per robot, every method around the chosen model and the paper's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pandas as pd

from softkin.core.samples import TEST
from softkin.models.spec import PAPERS_RUN
from softkin.reporting.tables.paper_layout import PaperTable, format_number
from softkin.uncertainty.intervals.spec import MARGINAL

HEADER = ("Method", "Around", "Promised", "Coverage (%)", "Mean width (mm)", "Winkler score (mm)")


def interval_table(
    metrics: pd.DataFrame,
    choice: pd.DataFrame,
    titles: Mapping[str, str],
    models: Mapping[str, str],
    methods: Mapping[str, str],
    notes: Sequence[str] = (),
) -> PaperTable:
    """A group of rows per dataset of `titles` (name -> title), a row per method and run.

    Shown is the level at which methods were compared, on `test`, averaged over the coordinates that move: the run that
    the chosen interval surrounds, then the paper's own. The chosen interval is named as such, and the lowest Winkler
    score among methods with a guarantee is bold. A dataset whose scores leak (column `leak`) says so in its heading.
    """
    rows: list[list[str]] = []
    bold: set[tuple[int, int]] = set()
    groups = []
    for dataset, title in titles.items():
        best = choice[(choice["dataset"] == dataset) & choice["chosen"]].iloc[0]
        here = metrics[
            (metrics["dataset"] == dataset)
            & (metrics["subset"] == TEST)
            & (metrics["coordinate"] == "mean_informative")
            & metrics["interval_method"].isin(methods)
            & (metrics["confidence_level"] == best["confidence_level"])
        ]
        runs = list(dict.fromkeys([(best["model"], best["preset"]), PAPERS_RUN]))
        parts = [here[(here["model"] == model) & (here["preset"] == preset)] for model, preset in runs]
        shown = pd.concat([part.assign(order=part["interval_method"].map(list(methods).index)) for part in parts])
        shown = shown.sort_values("order", kind="stable")
        guaranteed = shown.loc[shown["guarantee"] == MARGINAL, "winkler_mm"]
        for row in shown.itertuples():
            if row.guarantee == MARGINAL and row.winkler_mm == guaranteed.min():
                bold.add((len(rows), len(HEADER) - 1))
            is_chosen = all(getattr(row, key) == best[key] for key in ("model", "preset", "interval_method"))
            rows.append(
                [
                    methods[row.interval_method] + (", chosen" if is_chosen else ""),
                    f"{models[row.model]}, {row.preset}",
                    row.guarantee,
                    f"{100 * row.coverage:.1f}",
                    format_number(row.mean_width_mm),
                    format_number(row.winkler_mm),
                ]
            )
        groups.append((f"{title} (LEAK)" if shown["leak"].any() else title, len(shown)))
    level = float(choice["confidence_level"].iloc[0])
    remark = (
        f"Test rows, averaged over the coordinates that move; nominal coverage {level:.0%}. Chosen: the lowest Winkler "
        "score on validation rows alone. Bold: the lowest on test among the methods with a marginal guarantee."
    )
    return PaperTable("Prediction intervals, as measured", HEADER, rows, bold, groups, [remark, *notes])
