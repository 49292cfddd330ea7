"""What a person reads at the end of a run: what it did, its headline, and where its files are."""

from __future__ import annotations

import logging
import shlex
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path

from softkin.cli.store_address import STORE, ui_address
from softkin.core.files import read_json

RESULTS = Path("results")
HEADLINE = RESULTS / "tables" / "headline.txt"
CALIBRATED = "calibrated_model.joblib"
#: Files across datasets, and what they are.
FILES = {
    RESULTS / "report.html": "the whole run on one page",
    RESULTS / "tables": "the tables, as CSV, Markdown and LaTeX",
    RESULTS / "tables" / "paper_tables.md": "the paper's Tables 2 to 6 beside ours",
}


def final_screen(
    place: Path, made: Collection[str], datasets: Sequence[str], *, jobs: tuple[int, int], folder: Path = Path()
) -> str:
    """The text.

    Parameters:
        place: folder of the run, as the person who started it finds it; files are shown so.
        made: outputs that the run has made or found up to date, by their paths in that folder.
        datasets: of the run.
        jobs: how many jobs it did, and how many it would have done from nothing.
        folder: the same folder as this process finds it; the working folder by default.

    Returns:
        The headline and files, where this run is of them; else only how much it did.
    """
    lines = ["", f"softkin: {_done(*jobs)}"]
    paths = {Path(path) for path in made}
    if HEADLINE in paths:
        lines.append((folder / HEADLINE).read_text(encoding="utf-8"))
    shown = [*_files(place, paths, datasets)]
    width = max((len(path) for path, _ in shown), default=0)
    lines += [f"  {path:<{width}}  {what}" for path, what in shown]
    return "\n".join([*lines, *_links(paths, datasets, folder), ""])


def _done(did: int, of: int) -> str:
    """How much a run did, in words."""
    if did == 0:
        return "nothing was to be done, all that was asked for is up to date."
    rest = of - did
    return f"{did} job{'s' * (did > 1)} done" + (f", {rest} up to date." if rest else ".")


def _files(place: Path, made: Collection[Path], datasets: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Each file as the reader finds it, and what it is."""
    for file, what in FILES.items():
        if file in made or any(file in path.parents for path in made):
            yield str(place / file), what
    for dataset in datasets:
        file = RESULTS / dataset / CALIBRATED
        if file in made:
            yield str(place / file), f"the calibrated model of {dataset}"
    if any(path.name == "mlflow_runs.json" for path in made):
        which = "" if place == Path() else f" IN={shlex.quote(str(place))}"
        yield f"make ui{which}", "browse every run in the MLflow UI"


def _links(made: Collection[Path], datasets: Sequence[str], folder: Path) -> Iterator[str]:
    """A line for each dataset whose runs are in MLflow: where the UI shows them. Results of before 0.2 have no link."""
    logged = {name: RESULTS / name / "mlflow_runs.json" for name in datasets}
    found = {name: read_json(folder / file).get("link") for name, file in logged.items() if file in made}
    links = {name: link for name, link in found.items() if link}
    if not links:
        return
    base, width = ui_address(read_json(folder / STORE)["tracking_uri"]), max(map(len, links))
    for name, link in links.items():
        yield f"    {name:<{width}}  {base}{link}"


class AtMessage(logging.Handler):
    """Do something when a certain message is logged: Snakemake has no hook for a run that has nothing to do."""

    def __init__(self, message: str, do: Callable[[], object]) -> None:
        """`do` is called at each record whose text is `message`."""
        super().__init__()
        self.message, self.do = message, do

    def emit(self, record: logging.LogRecord) -> None:
        """Look at a record."""
        if record.getMessage() == self.message:
            self.do()
