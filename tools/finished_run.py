"""A finished run in its folder `results`: its tables, the descriptions of its datasets, and what things are called."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from softkin.core.errors import SoftkinError
from softkin.core.files import read_json
from softkin.data.audit.findings import leaking_subsets
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.reporting.tables.numbers import number_text
from softkin.reporting.tables.single_rows import Hanging, Number, hanging
from softkin.reporting.titles import Titles
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.labelled import LABELLED_METHODS
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.regions.spec import JOINT_INTERVALS, JOINT_TITLE
from tools.run_tables import RunTables

TITLES = Titles(
    {name: spec.title for name, spec in (MODELS | ENSEMBLES).items()},
    {
        **{name: method.title for name, method in INTERVAL_METHODS.items()},
        **{name: method.title for name, method in REGION_METHODS.items()},
        **{name: method.title for name, method in LABELLED_METHODS.items()},
        JOINT_INTERVALS: JOINT_TITLE,
    },
)


@dataclass(frozen=True)
class FinishedRun:
    """A run of the workflow, in its folder `results`."""

    results: Path

    @cached_property
    def tables(self) -> RunTables:
        """Its tables across datasets."""
        return RunTables(self.results / "tables")

    @cached_property
    def datasets(self) -> list[str]:
        """Names of its datasets, in the order of the configuration."""
        return [str(name) for name in self.tables.read("selection")["dataset"].unique()]

    @cached_property
    def hanging(self) -> dict[Number, Hanging]:
        """The numbers that hang on a single row or coordinate."""
        left_out = self.tables.read("left_out", "interval_method", "left_out")
        return hanging(left_out.fillna({"interval_method": ""}))

    def starred(self, value: float | None, number: Number) -> str:
        """A number as text, with a star where it hangs on a single row or coordinate."""
        return number_text(value) + "\\*" * (number in self.hanging)

    def description(self, dataset: str) -> dict[str, Any]:
        """Title, rows and hash of a dataset."""
        description: dict[str, Any] = read_json(self.results / dataset / "dataset.json")
        return description

    def card(self, dataset: str) -> dict[str, Any]:
        """The data card of a dataset."""
        card: dict[str, Any] = read_json(self.results / dataset / "data_card.json")
        return card

    def name(self, dataset: str, subset: str | None = None) -> str:
        """The title of a dataset without its remark in brackets, marked where scores on the subset leak."""
        leaks = subset in leaking_subsets(self.card(dataset))
        return str(self.description(dataset)["title"]).split(" (")[0] + (" (leak)" if leaks else "")


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def page_program(make: Callable[[Path, Path], None], page: Path, description: str | None) -> int:
    """What a tool that writes a page does: print the error, if any; return the exit status.

    Parameters:
        make: writes the page from the folder of results.
        page: where it goes by default.
        description: of the tool.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--page", type=Path, default=page)
    options = parser.parse_args()
    try:
        make(options.results, options.page)
    except SoftkinError as error:
        print(error, file=sys.stderr)
        return 1
    return 0
