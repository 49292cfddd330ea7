"""Claims of the paper that a run can check, each with its verdict and the numbers behind it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from softkin.core.samples import TEST
from softkin.evaluation.recorded_names import NEXT_SESSION, PLAIN, PUBLISHED
from softkin.models.estimators.memory_features import NONE

HOLDS, DOES_NOT = "not contradicted", "does not hold"
COLUMNS = ["claim", "source", "dataset", "verdict", "numbers"]
TIME_INDEPENDENT = "the actuation-to-position mapping is time-independent, so classical split conformal is used"


def claims(
    recorded: pd.DataFrame, descriptions: Sequence[Mapping[str, Any]], cards: Sequence[Mapping[str, Any]]
) -> pd.DataFrame:
    """One row per claim and published dataset that can check it.

    Parameters:
        recorded: scores in time, of all recorded datasets.
        descriptions: of the datasets.
        cards: their data cards, in the same order.
    """
    rows = [
        _time_independence(recorded[recorded["dataset"] == about["dataset"]], about["dataset"], card)
        for about, card in zip(descriptions, cards, strict=True)
        if about.get("origin") == "published" and (recorded["dataset"] == about["dataset"]).any()
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def _time_independence(scores: pd.DataFrame, dataset: str, card: Mapping[str, Any]) -> dict[str, str]:
    memory, codes = card["checks"]["memory"], {finding["code"] for finding in card["findings"]}
    numbers = []
    if "remembers" in memory:
        measured = memory["remembers"]
        largest = max(measured["lag_one"], key=measured["lag_one"].get)
        numbers.append(
            f"residuals of a fit by commands alone correlate with the next ones at {measured['lag_one'][largest]:.2f} "
            f"in {largest}, within a session at {measured['lag_one_within_sessions'][largest]:.2f} "
            f"(p = {measured['p_value']:.3g})"
        )
        zeros = memory["sessions_differ"]
        if "effect_mm" in zeros:
            widest = max(zeros["effect_mm"].values())
            numbers.append(f"zeros of sessions differ by up to {widest:.1f} mm (p = {zeros['p_value']:.3g})")
    on_test = scores[(scores["split"] == PUBLISHED) & (scores["subset"] == TEST)].set_index("memory")
    if len(on_test) > 1:
        before, after = on_test.loc[NONE, "rmse_mm"], on_test.drop(NONE)["rmse_mm"].iloc[0]
        numbers.append(f"memory and session take the RMSE on test from {before:.2f} to {after:.2f} mm")
    plain = scores[(scores["split"] == NEXT_SESSION) & (scores["n_recalibration_poses"] == 0)]
    plain = plain[plain["method"] == PLAIN]
    if len(plain):
        worst = plain.loc[plain["coverage"].idxmin()]
        numbers.append(
            f"split conformal intervals cover as little as {worst['coverage']:.0%} of a session ({worst['subset']})"
        )
    verdict = DOES_NOT if codes & {"remembers", "sessions_differ"} else HOLDS
    return {
        "claim": TIME_INDEPENDENT,
        "source": "the paper, on split conformal prediction",
        "dataset": dataset,
        "verdict": verdict,
        "numbers": "; ".join(numbers),
    }


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
