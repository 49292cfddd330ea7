"""Judge what a run of the workflow left, log it as a campaign, and move champions."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from softkin.campaigns.changes import Changes, changes_between
from softkin.campaigns.comparison import WORSE, Comparison, Tolerances, compare
from softkin.campaigns.verdict import FAILED, FIRST, UNCHANGED, Verdict, judge
from softkin.cli.store_address import store_address
from softkin.cli.workflow_process import Ended
from softkin.core.files import read_json, sha256_of
from softkin.core.samples import VALIDATION
from softkin.core.units import unit_of
from softkin.reporting.page.provenance import commit, versions
from softkin.tracking import nights
from softkin.tracking.store import client_of

#: Digits of hashes in sentences.
SHORT = 12
#: Relative difference that rounding may make when everything is redone.
ROUNDING = 1e-9
AUTO = "auto"


@dataclass(frozen=True, slots=True)
class Results:
    """What a run of the workflow left: its folder, when it started (seconds since the epoch), and how it ended."""

    folder: Path
    started: float
    ended: Ended

    def facts(self) -> dict[str, Any]:
        """What is known of the campaign besides its numbers."""
        checkout = commit(Path(__file__).resolve().parents[3])
        return {
            "started": time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(self.started)),
            "duration_seconds": round(time.time() - self.started, 1),
            "cpu_seconds": round(self.ended.cpu_seconds, 1),
            "jobs_run": self.ended.jobs_run,
            "jobs_reused": self.ended.jobs_reused,
            "commit": None if checkout is None else checkout[0] + ("-dirty" if checkout[1] else ""),
        }

    def summary(self) -> dict[str, Any]:
        """The summary of the results, with the versions of the software that is installed now."""
        software = versions() | {"code": _code_hash()}
        text = json.dumps(software, sort_keys=True)
        sha256 = hashlib.sha256(text.encode()).hexdigest()
        found: dict[str, Any] = read_json(self.folder / "tables" / "summary.json")
        return found | {"software": software, "software_sha256": sha256}

    @property
    def rows(self) -> Path:
        """The file of the rows that go with the summary."""
        return self.folder / "tables" / "summary_rows.parquet"

    def files(self) -> dict[str, list[Path]]:
        """The artifacts of a campaign with new results, by folder."""
        tables = self.folder / "tables"
        top = [self.folder / "report.html", tables / "headline.txt"]
        found = {"": top, "tables": sorted(tables.glob("*.csv"))}
        found |= {"tables/figures": sorted((tables / "figures").glob("*.*"))}
        return found | {f"runs/{path.parent.name}": [path] for path in self.folder.glob("*/mlflow_runs.json")}


def judge_results(results: Results, *, refit: bool) -> Verdict:
    """Compare with the last campaign, log this one, and move champions; return the verdict."""
    summary = results.summary()
    client = client_of(store_address(results.folder.parent))
    before, rows = nights.last_night(client, summary), pd.read_parquet(results.rows)
    moved: dict[nights.Candidate, str] = {}
    if before is None:
        verdict = Verdict(FIRST, facts=results.facts())
    else:
        changes, comparisons = _news(before, summary, rows)
        verdict = judge(comparisons, changes, jobs_run=results.ended.jobs_run, facts=results.facts())
        if refit:
            verdict = _of_refit(before, summary, verdict)
    if summary["configuration"].get("promote", AUTO) == AUTO:
        moved = _moved(client, summary, rows, verdict)
    facts = {**verdict.facts, "promoted": ", ".join(f"{one.name} {one.version}" for one in moved) or "none"}
    verdict = Verdict(verdict.outcome, verdict.reasons, verdict.changes, verdict.comparisons, facts)
    same_as = before.run_id if before and verdict.outcome == UNCHANGED else None
    files = {} if same_as else results.files()
    page = verdict.as_markdown()
    record = nights.NightRecord(verdict.as_dict(), page, summary, results.rows, files, results.started, same_as)
    run_id = nights.log_night(client, record)
    nights.move_champions(client, moved, list(summary["datasets"]), run_id)
    return verdict


def log_failure(results: Results, reasons: Sequence[str]) -> Verdict:
    """The verdict on a workflow that failed, logged where there is a store."""
    verdict = Verdict(FAILED, reasons, facts=results.facts())
    store = results.folder / "mlflow_store.json"
    known = (results.folder / "tables" / "summary.json").exists()
    if store.exists():
        client = client_of(store_address(results.folder.parent))
        summary = results.summary() if known else None
        page = verdict.as_markdown()
        nights.log_night(client, nights.NightRecord(verdict.as_dict(), page, summary, None, {}, results.started))
    return verdict


def _news(before: nights.Night, summary: Mapping[str, Any], rows: pd.DataFrame) -> tuple[Changes, list[Comparison]]:
    """What changed since a campaign, and how its numbers compare."""
    comparisons = compare(
        before.rows,
        rows,
        confidence_level=summary["confidence_level"],
        calibration_rows={name: data["rows"][VALIDATION] for name, data in summary["datasets"].items()},
        tolerances=Tolerances(**summary["configuration"].get("verdict", {})),
        units={name: unit_of(data) for name, data in summary["datasets"].items()},
        seed=summary["seed"],
    )
    return changes_between(before.summary, summary), comparisons


def _moved(
    client: Any, summary: Mapping[str, Any], rows: pd.DataFrame, verdict: Verdict
) -> dict[nights.Candidate, str]:
    """The candidates that become champions, with their reasons: those that are no worse than the champion was."""
    moved = {}
    for candidate in nights.candidates(client, list(summary["datasets"])):
        comparisons, person = list(verdict.comparisons), list(verdict.reasons)
        judged = nights.night_of(client, candidate.judged_in) if candidate.judged_in else None
        if judged is not None and judged.summary["format"] == summary["format"]:
            changes, comparisons = _news(judged, summary, rows)
            person = changes.for_a_person
        of_dataset = [one for one in comparisons if one.dataset == candidate.dataset]
        needs_person = any(sentence.startswith(f"{candidate.dataset}:") for sentence in person)
        if not needs_person and all(one.outcome != WORSE for one in of_dataset):
            moved[candidate] = (
                f"nothing is worse than with version {candidate.champion} ({len(of_dataset)} numbers compared)"
                if of_dataset
                else f"no campaign has numbers of version {candidate.champion} that it could be compared with"
            )
    return moved


def _of_refit(before: nights.Night, summary: Mapping[str, Any], verdict: Verdict) -> Verdict:
    """The verdict on a campaign that redid everything: numbers that nothing explains are a failure."""
    if verdict.changes or verdict.outcome == "data_changed":
        return verdict
    differ = []
    for name, data in summary["datasets"].items():
        for metric, now in data["metrics"].items():
            old = before.summary["datasets"].get(name, {}).get("metrics", {}).get(metric)
            if old != now and (old is None or now is None or abs(now - old) > ROUNDING * abs(old)):
                differ.append(f"{name}: {metric} is {now}, before {old}, and nothing was changed.")
    return Verdict(FAILED, differ, verdict.changes, verdict.comparisons, verdict.facts) if differ else verdict


def _code_hash() -> str:
    """Hash of softkin's own code: the package and the workflow."""
    house = Path(__file__).resolve().parents[3]
    files = [*(house / "src").rglob("*.py"), *(house / "workflow").rglob("*.smk"), *(house / "workflow").rglob("*.py")]
    return sha256_of(sorted(files))[:SHORT]
