"""The table of claims: each with its verdict, the numbers that decide it, and the rows that do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import pandas as pd

from softkin.core.samples import TEST
from softkin.reporting.claims.measured import Measured
from softkin.reporting.claims.spec import NOT_ASSESSABLE, Case, ClaimSpec, Judged, judged

COLUMNS = ["claim", "text", "where", "verdict", "settings", "numbers", "rule", "decided_by", "table", "command"]
COMMAND = "make run"
#: Tables whose numbers are means over rows; a claim that other tables decide hangs on no single row.
MEANS_OVER_ROWS = ("point_metrics.csv", "interval_metrics.csv")
#: How a row begins without which the verdict itself would be another.
VERDICT_TURNS = "the verdict: "
#: A row left out: its dataset and subset, which one it is, and everything measured without it.
LeftOut = tuple[str, Measured]


def claims_table(claims: Mapping[str, ClaimSpec], measured: Measured, left_out: pd.DataFrame | None) -> pd.DataFrame:
    """A row per claim (`COLUMNS`). Which claims there are, and in which order, is the same for every run.

    Parameters:
        claims: the registry.
        measured: what the run measured.
        left_out: as in left_out.csv; None: nothing is said of single rows.
    """
    variants = list(variants_of(measured, left_out)) if left_out is not None else []
    rows = []
    for name, claim in claims.items():
        verdict = judged(claim, measured)
        row = {"claim": name, "text": claim.text, "where": claim.where, "verdict": verdict.verdict}
        row |= {
            "settings": "; ".join(verdict.settings),
            "numbers": numbers_text(claim, verdict),
            "rule": claim.rule_text,
        }
        hangs_on_rows = claim.table in MEANS_OVER_ROWS
        row["decided_by"] = "; ".join(deciding_rows(claim, verdict, variants if hangs_on_rows else []))
        rows.append(row | {"table": claim.table, "command": COMMAND})
    return pd.DataFrame(rows, columns=COLUMNS)


def variants_of(measured: Measured, left_out: pd.DataFrame) -> Iterator[LeftOut]:
    """What was measured without each single row that moves some number."""
    of_rows = left_out[left_out["left_out"].str.startswith("row ")]
    for (dataset, subset, row), rows in of_rows.groupby(["dataset", "subset", "left_out"], sort=False):
        if dataset in measured.robots():
            yield f"{dataset} {subset}, {row}", measured.without(rows)


def deciding_rows(claim: ClaimSpec, whole: Judged, variants: list[LeftOut]) -> Iterator[str]:
    """The single rows without which the verdict, the settings or one case would be another."""
    before = {(case.setting, case.place): case.holds for case in whole.cases}
    turned: dict[tuple[str, str], list[str]] = {}
    for name, without in variants:
        after = judged(claim, without)
        if (after.verdict, after.settings) != (whole.verdict, whole.settings):
            settings = f" ({'; '.join(after.settings)})" if after.settings else ""
            yield f"{VERDICT_TURNS}without {name} it is '{after.verdict}{settings}'"
            continue
        for case in after.cases:
            key = (case.setting, case.place)
            if before.get(key, case.holds) != case.holds:
                turned.setdefault(key, []).append(name)
    for (setting, place), names in turned.items():
        more = f" or {len(names) - 1} others" if len(names) > 1 else ""
        yield f"{setting}, {place}: turned by {names[0]}{more}, not the verdict"


def numbers_text(claim: ClaimSpec, verdict: Judged) -> str:
    """The cases in words, setting by setting; what is missing where nothing could be decided."""
    if verdict.verdict == NOT_ASSESSABLE:
        return f"it would take {claim.missing}"
    texts = []
    for setting in dict.fromkeys(case.setting for case in verdict.cases):
        cases = [case for case in verdict.cases if case.setting == setting]
        n_holds = sum(case.holds for case in cases)
        texts.append(f"{setting}: {n_holds} of {len(cases)} ({'; '.join(_told(cases))})")
    return ". ".join(texts)


def _told(cases: list[Case]) -> Iterator[str]:
    """Each case; a number that several share once."""
    by_number: dict[str, list[str]] = {}
    for case in cases:
        by_number.setdefault(case.number, []).append(
            case.place.removesuffix(f" {TEST}") if _all_test(cases) else case.place
        )
    for number, places in by_number.items():
        yield f"{', '.join(places)}: {number}"


def _all_test(cases: list[Case]) -> bool:
    return all(case.place.endswith(f" {TEST}") for case in cases)
