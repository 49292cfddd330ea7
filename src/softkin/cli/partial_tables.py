"""Tables and report of the datasets that are complete, when a job of another one has failed."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softkin.core.files import write_json

#: What needs no other file of the datasets that are left out, and writes nothing to the store.
RULES = ("build_tables", "draw_campaign_figures", "build_report")
#: A job of these that has not been done leaves the tables of its dataset whole.
AFTER_THE_TABLES = ("track",)
#: Set while such tables are made: they are made once.
PARTIAL = "SOFTKIN_PARTIAL"


@dataclass(frozen=True, slots=True)
class Undone:
    """A job that failed, or was not started since another one failed; `dataset` is empty where it is of all."""

    rule: str
    dataset: str
    words: str
    failed: bool


def complete_datasets(datasets: Sequence[str], undone: Collection[Undone]) -> list[str]:
    """The datasets whose tables can be made. Empty where all can, so that no job of theirs is why the run failed."""
    incomplete = {job.dataset for job in undone if job.rule not in AFTER_THE_TABLES}
    complete = [name for name in datasets if name not in incomplete]
    return complete if len(complete) < len(datasets) else []


def what_is_missing(datasets: Sequence[str], complete: Collection[str], undone: Collection[Undone]) -> str:
    """A sentence that names the datasets that are left out, and the jobs that failed."""
    named = []
    for name in datasets:
        if name not in complete:
            failed = sorted(job.words for job in undone if job.dataset == name and job.failed)
            named.append(f"{name} ({', '.join(failed)} failed)" if failed else name)
    return f"Incomplete: without {', '.join(named)}."


def run_without(
    missing: str, complete: Sequence[str], config: Mapping[str, Any], *, command: Sequence[str], report: str
) -> int:
    """Make tables and report of the complete datasets in the working folder; return Snakemake's exit code.

    They go where those of all datasets go, say what is missing, and are made anew by the next run that has all.

    Parameters:
        missing: what is missing, a sentence.
        complete: the datasets.
        config: of the run.
        command: of Snakemake, up to its options.
        report: what is asked for.
    """
    caution = " ".join(filter(None, (missing, config.get("caution"))))
    file = Path(".snakemake") / "softkin_partial.json"
    write_json(file, {**config, "datasets": list(complete), "caution": caution})
    options = ["--cores", "1", "--nolock", "--configfile", str(file.resolve()), "--allowed-rules", *RULES]
    environment = os.environ | {PARTIAL: "1"}
    return subprocess.run([*command, *options, "--", report], env=environment, check=False).returncode
