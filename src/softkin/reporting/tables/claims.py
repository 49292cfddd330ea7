"""The paper's claims with the verdicts of a run, and what memory makes of a dataset that the paper has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from softkin.core.recording import NONE
from softkin.evaluation.recorded_names import PUBLISHED
from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.measured import measured
from softkin.reporting.claims.table import COLUMNS, claims_table


def claims(
    frames: Mapping[str, pd.DataFrame],
    printed: Mapping[str, pd.DataFrame],
    descriptions: Sequence[Mapping[str, Any]],
    cards: Sequence[Mapping[str, Any]],
) -> pd.DataFrame:
    """One row per claim; none where no dataset of the run is published.

    Parameters:
        frames: the tables of the run, by name.
        printed: what the paper printed besides: `subsets`, `approaches`, `improvements`.
        descriptions: of the datasets.
        cards: their data cards, in the same order.
    """
    if all(about.get("origin") != "published" for about in descriptions):
        return pd.DataFrame(columns=COLUMNS)
    return claims_table(CLAIMS, measured({**frames, **printed}, descriptions, cards), frames["left_out"])


def with_memory(dataset: str, sources: Mapping[str, Mapping[str, Any]], recorded: pd.DataFrame | None) -> list[str]:
    """The extra row of a comparison with the paper, as a sentence: what memory and session make of the same file.

    Parameters:
        dataset: the dataset that is compared with the paper.
        sources: the datasets' entries.
        recorded: scores in time; None where there are none.
    """
    twins = [
        name
        for name, entry in sources.items()
        if name != dataset and "sha256" in entry and entry["sha256"] == sources[dataset].get("sha256")
    ]
    if recorded is None or "paper_table" not in sources[dataset]:
        return []
    rows = recorded[recorded["dataset"].isin(twins) & (recorded["split"] == PUBLISHED)]
    rows = rows[rows["memory"] != NONE]
    return [
        f"With memory and session ({row.dataset}: {row.model}, {row.preset}), {row.subset}: RMSE {row.rmse_mm:.2f} mm, "
        f"MAE {row.mae_mm:.2f} mm."
        for row in rows.itertuples()
    ]
