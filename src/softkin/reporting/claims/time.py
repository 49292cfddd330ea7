"""The claim that positions depend on the command alone, whatever came before it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from softkin.core.recording import NONE
from softkin.core.samples import TEST
from softkin.evaluation.recorded_names import NEXT_SESSION, PLAIN, PUBLISHED
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import Case, ClaimSpec

#: Findings of the audit that refute it.
REFUTE = {"remembers", "sessions_differ"}


def _time_independent(measured: Measured) -> Iterator[Case]:
    recorded = measured.frames.get("recorded")
    if recorded is None:
        return
    for dataset in measured.datasets:
        scores = recorded[recorded["dataset"] == dataset]
        if len(scores):
            card = measured.cards[dataset]
            codes = {finding["code"] for finding in card["findings"]}
            numbers = [*_of_memory(card["checks"]["memory"]), *_of_scores(scores)]
            yield Case("as recorded", dataset, not codes & REFUTE, "; ".join(numbers))


def _of_memory(memory: Mapping[str, Any]) -> Iterator[str]:
    """What the audit measured of memory and zeros."""
    if "remembers" not in memory:
        return
    of = memory["remembers"]
    largest = max(of["lag_one"], key=of["lag_one"].get)
    yield (
        f"residuals of a fit by commands alone correlate with the next ones at {of['lag_one'][largest]:.2f} "
        f"in {largest}, within a session at {of['lag_one_within_sessions'][largest]:.2f} (p = {of['p_value']:.3g})"
    )
    zeros = memory["sessions_differ"]
    if "effect_mm" in zeros:
        widest = max(zeros["effect_mm"].values())
        yield f"zeros of sessions differ by up to {widest:.1f} mm (p = {zeros['p_value']:.3g})"


def _of_scores(scores: pd.DataFrame) -> Iterator[str]:
    """What memory takes off the error, and what intervals cover in a session never seen."""
    on_test = scores[(scores["split"] == PUBLISHED) & (scores["subset"] == TEST)].set_index("memory")
    if len(on_test) > 1:
        before, after = on_test.loc[NONE, "rmse_mm"], on_test.drop(NONE)["rmse_mm"].iloc[0]
        yield f"memory and session take the RMSE on test from {before:.2f} to {after:.2f} mm"
    plain = scores[(scores["split"] == NEXT_SESSION) & (scores["n_recalibration_poses"] == 0)]
    plain = plain[plain["method"] == PLAIN]
    if len(plain):
        worst = plain.loc[plain["coverage"].idxmin()]
        yield f"split conformal intervals cover as little as {worst['coverage']:.0%} of a session ({worst['subset']})"


TIME_INDEPENDENT = ClaimSpec(
    name="time_independent",
    text="the actuation-to-position mapping is time-independent, so classical split conformal is used",
    where="section 3",
    rule=_time_independent,
    rule_text="the audit finds neither memory nor sessions that differ, in the order of the recording",
    table="recorded.csv",
    missing="a published robot whose recording order is known, complete",
)
