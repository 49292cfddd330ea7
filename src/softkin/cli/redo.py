"""Have results that are not as softkin wrote them made anew: at the start of each run, before Snakemake looks."""

from __future__ import annotations

import json
from base64 import urlsafe_b64encode
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from softkin.core.job_params import other_params
from softkin.core.job_records import Damage, Records, damages, records

RESULTS = Path("results")
#: Where Snakemake (9.27.1) keeps a file for each output that a job has not finished: it is made anew.
UNFINISHED = Path(".snakemake") / "incomplete"
#: Where it keeps a file for each output with the params that it was made with.
FINISHED = Path(".snakemake") / "metadata"
#: Files that are named one by one.
MOST_NAMED = 10


@dataclass(frozen=True, slots=True)
class Unknown:
    """A job of whose params Snakemake has lost its record: its words (`fit_model finger gp`), the hashes of the params
    that it had, and the outputs that this is true of.
    """

    job: str
    params: Mapping[str, str]
    outputs: Sequence[Path]


def redo_damaged(*, only_say: bool) -> tuple[list[str], list[Unknown]]:
    """Mark every output that is not as it was written as unfinished; `only_say` marks none.

    What was made from it is made anew, too, where its content was another: Snakemake knows the hashes of inputs.

    Returns:
        What is wrong, in sentences, and what `redo_changed` looks at: the records of the jobs are read once.
    """
    unknown: list[Unknown] = []
    found = list(damages(RESULTS, thorough=False, known=_noting(unknown)))
    if not only_say:
        for output in {damage.output for damage in found}:
            _mark(output)
    return [f"{sentence}; it is made anew" for sentence in sentences(found)], unknown


def _noting(unknown: list[Unknown]) -> Records:
    """The records of all jobs; those whose params Snakemake does not know are noted."""
    for record, content in records(RESULTS):
        if content is not None and content.get("params"):
            outputs = {Path(entry["output"]) for entry in content["files"].values()}
            # A folder that is gone was removed on purpose, with all that is in it.
            lost = [output for output in outputs if not _place(FINISHED, output).exists() and output.parent.is_dir()]
            if lost:
                unknown.append(Unknown(content["job"], content["params"], lost))
        yield record, content


def redo_changed(
    unknown: Iterable[Unknown], params_of: Callable[[str], Mapping[str, Any] | None], *, only_say: bool
) -> Iterator[str]:
    """Mark every output that was made with other params as unfinished where Snakemake has lost its own record of them,
    and say so; `only_say` marks none.

    Parameters:
        unknown: the jobs whose params Snakemake does not know, by `redo_damaged`.
        params_of: the words of a job -> its params now; None where there is no such job.
        only_say: whether this run only looks.
    """
    found = []
    for job in unknown:
        params = params_of(job.job)
        others = [] if params is None else other_params(job.params, params)
        if others:
            found.append(f"{job.job} was done with other params ({', '.join(others)}); it is done anew")
            for output in job.outputs if not only_say else ():
                _mark(output)
    left = len(found) - MOST_NAMED
    yield from found[:MOST_NAMED]
    if left > 0:
        yield f"{left} more jobs were done with other params; they are done anew"


def sentences(found: Sequence[Damage]) -> list[str]:
    """What is wrong with each file, the first ones by name."""
    words = {"missing": "is gone", "changed": "was changed since it was written"}
    named = [f"{damage.path} {words[damage.what]} ({damage.job})" for damage in found[:MOST_NAMED]]
    left = len(found) - len(named)
    return named + [f"{left} more files are gone or were changed"] * bool(left)


def _mark(output: Path) -> None:
    if not output.exists():
        # Snakemake overlooks an output that is gone while all that was made from it is there. An empty one it sees.
        output.touch()
    marker = _place(UNFINISHED, output)
    marker.parent.mkdir(parents=True, exist_ok=True)
    marker.write_text(json.dumps({"external_jobid": None}), encoding="utf-8")


def _place(folder: Path, output: Path) -> Path:
    """The file in a folder of Snakemake's records that is of an output."""
    key = urlsafe_b64encode(output.as_posix().encode()).decode()
    # As Snakemake does it, since names of files are at most 255 bytes long.
    pieces = [key[start : start + 254] for start in range(0, len(key), 254)]
    return folder.joinpath(*(f"@{piece}" for piece in pieces[:-1]), pieces[-1])
