"""Have results that are not as softkin wrote them made anew: at the start of each run, before Snakemake looks."""

from __future__ import annotations

import json
from base64 import urlsafe_b64encode
from collections.abc import Iterator, Sequence
from pathlib import Path

from softkin.core.job_records import Damage, damages

RESULTS = Path("results")
#: Where Snakemake (9.27.1) keeps a file for each output that a job has not finished: it is made anew.
UNFINISHED = Path(".snakemake") / "incomplete"
#: Files that are named one by one.
MOST_NAMED = 10


def redo_damaged(*, only_say: bool) -> Iterator[str]:
    """Mark every output that is not as it was written as unfinished, and say so; `only_say` marks none.

    What was made from it is made anew, too, where its content was another: Snakemake knows the hashes of inputs.
    """
    found = list(damages(RESULTS, thorough=False))
    if not only_say:
        for output in {damage.output for damage in found}:
            _mark(output)
    yield from (f"{sentence}; it is made anew" for sentence in sentences(found))


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
    key = urlsafe_b64encode(output.as_posix().encode()).decode()
    # As Snakemake does it, since names of files are at most 255 bytes long.
    pieces = [key[start : start + 254] for start in range(0, len(key), 254)]
    marker = UNFINISHED.joinpath(*(f"@{piece}" for piece in pieces[:-1]), pieces[-1])
    marker.parent.mkdir(parents=True, exist_ok=True)
    marker.write_text(json.dumps({"external_jobid": None}), encoding="utf-8")
