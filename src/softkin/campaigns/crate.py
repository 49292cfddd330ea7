"""Describe the results of a run as a Workflow Run RO-Crate: the files a workflow made, from what, when, their hashes.

The profile is https://w3id.org/ro/wfrun/workflow/0.5, of RO-Crate 1.1; `make campaigns` asks `roc-validator`.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from urllib.parse import quote

from softkin import __version__
from softkin.core.files import write_json
from softkin.core.job_records import records

METADATA = "ro-crate-metadata.json"
CRATE = "https://w3id.org/ro/crate/1.1"
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": ("Process Run Crate", "0.5"),
    "https://w3id.org/ro/wfrun/workflow/0.5": ("Workflow Run Crate", "0.5"),
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": ("Workflow RO-Crate", "1.0"),
}
LANGUAGE = "https://w3id.org/workflowhub/workflow-ro-crate#snakemake"
LICENCE = "https://spdx.org/licenses/MIT"
RUN = "#run"
#: Ending -> media type.
FORMATS = {
    ".csv": "text/csv",
    ".json": "application/json",
    ".md": "text/markdown",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".html": "text/html",
    ".txt": "text/plain",
    ".tex": "application/x-tex",
    ".parquet": "application/vnd.apache.parquet",
}
#: Result files that a run begins with.
RETRIEVED = "retrieve"


def write_crate(results: str | Path, *, workflow: str | Path, title: str, started: float, ended: float) -> Path:
    """Write the metadata of the crate beside the results; return its path.

    Files and hashes are those that the jobs recorded. The workflow's own file is copied beside them.

    Parameters:
        results: the folder of results, which becomes the crate.
        workflow: the Snakefile.
        title: of the run.
        started, ended: seconds since the epoch.
    """
    folder = Path(results)
    shutil.copyfile(workflow, folder / "Snakefile")
    files = list(_recorded(folder))
    made = [entity for job, entity in files if job != RETRIEVED]
    given = [entity for job, entity in files if job == RETRIEVED]
    action = {
        "@id": RUN,
        "@type": "CreateAction",
        "name": title,
        "instrument": {"@id": "Snakefile"},
        "startTime": _moment(started),
        "endTime": _moment(ended),
        "actionStatus": "http://schema.org/CompletedActionStatus",
        "object": _references(given),
        "result": _references(made),
    }
    graph = [*_about(title, ended, [entity for _, entity in files]), action, *(entity for _, entity in files)]
    write_json(folder / METADATA, {"@context": f"{CRATE}/context", "@graph": graph})
    return folder / METADATA


def _about(title: str, ended: float, files: Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """The crate, its metadata, its profiles, and the workflow."""
    profiles = [{"@id": name} for name in PROFILES]
    parts = [{"@id": "Snakefile"}, *_references(files)]
    return [
        {
            "@id": METADATA,
            "@type": "CreativeWork",
            "about": {"@id": "./"},
            "conformsTo": [{"@id": CRATE}, {"@id": "https://w3id.org/workflowhub/workflow-ro-crate/1.0"}],
        },
        {
            "@id": "./",
            "@type": "Dataset",
            "name": title,
            "description": "Forward kinematics of soft robots and how far to trust them: what softkin made in one run.",
            "datePublished": _moment(ended),
            "license": {"@id": LICENCE},
            "conformsTo": profiles,
            "mainEntity": {"@id": "Snakefile"},
            "mentions": [{"@id": RUN}],
            "hasPart": parts,
        },
        *(
            {"@id": name, "@type": "CreativeWork", "name": called, "version": version}
            for name, (called, version) in PROFILES.items()
        ),
        {"@id": LICENCE, "@type": "CreativeWork", "name": "MIT License", "identifier": LICENCE},
        {
            "@id": "Snakefile",
            "@type": ["File", "SoftwareSourceCode", "ComputationalWorkflow"],
            "name": "softkin",
            "version": __version__,
            "license": {"@id": LICENCE},
            "programmingLanguage": {"@id": LANGUAGE},
        },
        {
            "@id": LANGUAGE,
            "@type": "ComputerLanguage",
            "name": "Snakemake",
            "alternateName": "snakemake",
            "identifier": {"@id": "https://doi.org/10.1093/bioinformatics/bts480"},
            "url": {"@id": "https://snakemake.readthedocs.io"},
        },
    ]


def _recorded(folder: Path) -> Iterable[tuple[str, dict[str, Any]]]:
    """(rule, entity) of each file that a job recorded and that is there."""
    for content in filter(None, (content for _, content in records(folder))):
        for name, known in content["files"].items():
            path = folder.parent / name
            if path.is_file() and path.name != METADATA:
                inside = path.relative_to(folder).as_posix()
                entity = {"@id": quote(inside), "@type": "File", "name": inside, "sha256": known["sha256"]}
                entity |= {"contentSize": str(known["bytes"])}
                if path.suffix in FORMATS:
                    entity["encodingFormat"] = FORMATS[path.suffix]
                yield content["job"].split(" ")[0], entity


def _references(entities: Iterable[Mapping[str, Any]]) -> list[dict[str, str]]:
    return [{"@id": entity["@id"]} for entity in entities]


def _moment(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, UTC).isoformat(timespec="seconds")
