"""Tables and report of what is there, when a job has failed: without a model or a method of a dataset, or without the
dataset where it cannot do without what failed.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from softkin.core.failed_parts import PARTS
from softkin.core.files import write_json
from softkin.core.narrowing import groups, name_of, narrowed_configuration

#: What is made again of what is there. None of them writes to the store.
OF_A_DATASET = (
    *("fit_ensemble", "fit_orientation", "refit", "calibrate", "score", "score_recorded", "learning_curve"),
    "draw_figures",
)
RULES = (*OF_A_DATASET, "build_tables", "draw_campaign_figures", "build_report")
#: A job of these that has not been done leaves the tables of its dataset whole.
AFTER_THE_TABLES = ("track",)
#: Jobs of one entry of a key of the configuration.
OF_ONE = {"fit_model": "models", "fit_ensemble": "ensembles", "fit_quantiles": "quantile_models"}
#: Set while such tables are made, as JSON: what is `left_out`, by dataset and key of the configuration, and datasets
#: that are `complete`.
PARTIAL = "SOFTKIN_PARTIAL"

#: Key of the configuration -> names that are left out.
LeftOut = dict[str, list[str]]


@dataclass(frozen=True, slots=True)
class Undone:
    """A job that failed, or was not started since another one failed; `dataset` is empty where it is of all.

    `parts` are what it is of, or failed on, as (key of the configuration, name); empty where nobody knows.
    """

    rule: str
    dataset: str
    words: str
    failed: bool
    parts: Sequence[tuple[str, str]] = ()


@dataclass(frozen=True, slots=True)
class Partial:
    """What tables are made of: these datasets, each without what `left_out` says; `missing` says it in a sentence. Of
    those that are `complete` nothing is to be done.
    """

    datasets: list[str]
    left_out: dict[str, LeftOut] = field(default_factory=dict)
    missing: str = ""
    complete: list[str] = field(default_factory=list)


def plan(
    config: Mapping[str, Any],
    undone: Collection[Undone],
    *,
    left_out: Mapping[str, LeftOut],
    on_quantiles: Collection[str],
    complete: Collection[str] | None = None,
) -> Partial | None:
    """What tables can be made of when a run has failed; None where that is nothing, or no less than the run tried.

    Parameters:
        config: of the run.
        undone: its jobs that have not been done.
        left_out: what the run left out already, by dataset.
        on_quantiles: the interval methods that need quantile regressors.
        complete: the datasets that a run was told are complete, where it makes tables of what is there; None: it makes
            those of everything.
    """
    datasets, parts, words, done = [], {}, [], []
    for dataset in config["datasets"]:
        jobs = [job for job in undone if job.dataset == dataset and job.rule not in AFTER_THE_TABLES]
        new = _without(jobs)
        out = (
            None
            if new is None
            else _together(narrowed_configuration(config, dataset), left_out.get(dataset, {}), new, on_quantiles)
        )
        if new is None or out is None:
            words.append(_with_jobs(dataset, jobs))
            continue
        datasets.append(dataset)
        if not jobs and (complete is None or dataset in complete):
            done.append(dataset)
        if out:
            parts[dataset] = out
        for key, names in new.items():
            words += [
                _with_jobs(f"the {PARTS[key]} {name} on {dataset}", [job for job in jobs if (key, name) in job.parts])
                for name in names
            ]
    if not datasets or not words:
        return None
    return Partial(datasets, parts, f"Incomplete: without {', '.join(words)}.", done)


def _without(jobs: Collection[Undone]) -> LeftOut | None:
    """What a dataset must do without when these jobs of it have not been done; None where it cannot."""
    out: LeftOut = {}
    for job in jobs:
        if job.rule in OF_A_DATASET and not job.failed:
            continue
        if not job.parts or job.rule not in (*OF_A_DATASET, *OF_ONE):
            return None
        for key, name in job.parts:
            out[key] = [*dict.fromkeys([*out.get(key, []), name])]
    return out


def _together(
    config: Mapping[str, Any], before: LeftOut, new: LeftOut, on_quantiles: Collection[str]
) -> LeftOut | None:
    """All that a dataset does without; None where that is all models, or all interval methods."""
    out = {key: [*dict.fromkeys([*before.get(key, []), *new.get(key, [])])] for key in {**before, **new}}
    if config["quantile_models"] and set(config["quantile_models"]) <= set(out.get("quantile_models", [])):
        methods = [name for name in config["interval_methods"] if name in on_quantiles]
        out["interval_methods"] = [*dict.fromkeys([*out.get("interval_methods", []), *methods])]
    is_bare = any(set(config[key]) <= set(out.get(key, [])) for key in ("models", "interval_methods"))
    return None if is_bare else {key: names for key, names in out.items() if names}


def _with_jobs(what: str, jobs: Collection[Undone]) -> str:
    """What is missing, and the jobs of it that failed."""
    failed = sorted(job.words for job in jobs if job.failed)
    return f"{what} ({', '.join(failed)} failed)" if failed else what


def run_partial(partial: Partial, config: Mapping[str, Any], *, command: Sequence[str], cores: int, report: str) -> int:
    """Make tables and report of what is there in the working folder; return Snakemake's exit code.

    They go where those of everything go, say what is missing, and are made anew by the next run that has all.

    Parameters:
        partial: what they are made of.
        config: of the run.
        command: of Snakemake, up to its options.
        cores: jobs at a time.
        report: what is asked for.
    """
    caution = " ".join(filter(None, (partial.missing, config.get("caution"))))
    file = Path(".snakemake") / "softkin_partial.json"
    write_json(file, {**config, "datasets": partial.datasets, "caution": caution})
    options = ["--cores", str(cores), "--nolock", "--configfile", str(file.resolve())]
    options += ["--allowed-rules", *(name_of(rule, group) for group in groups(config) for rule in RULES)]
    told = {"left_out": partial.left_out, "complete": partial.complete}
    environment = os.environ | {PARTIAL: json.dumps(told)}
    return subprocess.run([*command, *options, "--", report], env=environment, check=False).returncode
