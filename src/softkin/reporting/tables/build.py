"""Write the tables of a run into results/tables: CSV, Markdown, LaTeX, and the headline."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from softkin.core.csv_tables import write_csv
from softkin.core.escaping import csv_frame, markdown_text, one_line
from softkin.core.files import write_text
from softkin.core.runs import OUTER, PAPER, TUNED
from softkin.core.samples import TEST
from softkin.reporting.tables.claims import with_memory
from softkin.reporting.tables.frames import Tables
from softkin.reporting.tables.headline import headline
from softkin.reporting.tables.interval_layout import interval_table
from softkin.reporting.tables.orientation import orientation_sentences
from softkin.reporting.tables.paper_layout import (
    SUBSET_TITLES,
    PaperTable,
    comparison_table,
    presets_of,
    subset_table,
)
from softkin.reporting.tables.published import summary
from softkin.reporting.tables.published_intervals import table_6
from softkin.reporting.titles import Titles
from softkin.training.selection import deployed

#: What the columns of a preset are.
PRESET_COLUMNS = {
    PAPER: "ours with the paper's settings (paper)",
    TUNED: "ours with the settings that cross-validation found (tuned)",
    OUTER: "ours with the settings that outer shells of train found (outer)",
}
COUNTS = ("no column", "one column", "two columns", "three columns", "four columns")


def build_tables(tables: Tables, *, titles: Titles, folder: Path, caution: str | None = None) -> None:
    """Write every table into `folder`: each frame as CSV, those for a paper as Markdown and LaTeX, the headline.

    Parameters:
        tables: what they show.
        titles: of models and interval methods.
        folder: where they go.
        caution: what the configuration says of its own numbers; headline and Markdown repeat it.
    """
    frames = tables.frames
    for name, frame in frames.items():
        write_csv(folder / f"{name}.csv", csv_frame(frame))
    robots = {name: entry["title"] for name, entry in tables.sources.items()}
    sentences = summary(frames["published_comparison"], frames.get("published_columns"))
    turned = orientation_sentences(frames.get("orientation"))
    preface = _preface([*map(markdown_text, _cautions(caution)), *sentences], presets_of(frames["point_metrics"]))
    papers = _papers_tables(tables, titles)
    write_text(folder / "paper_tables.md", "\n".join([preface, *(table.markdown() for table in papers)]))
    write_text(folder / "paper_tables.tex", "\n".join(table.latex() for table in papers))
    remarks = _cautions(caution)
    remarks += [f"{robots[dataset]}, {s}: {note}" for (dataset, s), note in tables.notes.items() if s == TEST]
    ours = interval_table(frames["interval_metrics"], frames["interval_choice"], robots, titles, remarks)
    write_text(folder / "interval_tables.md", ours.markdown())
    write_text(folder / "interval_tables.tex", ours.latex())
    selected = deployed(frames["selection"]) if "selection" in frames else None
    found = {card["dataset"]: card["findings"] for card in tables.cards}
    text = headline(
        selected,
        frames["point_metrics"],
        frames["interval_choice"],
        [*turned, *sentences],
        found,
        caution,
        frames["interval_metrics"],
        frames["left_out"],
    )
    write_text(folder / "headline.txt", text)


def _cautions(caution: str | None) -> list[str]:
    return [f"CAUTION: {one_line(caution)}"] if caution else []


def _papers_tables(tables: Tables, titles: Titles) -> list[PaperTable]:
    """Table 2, a comparison per dataset, and Table 6 where the paper has cells of these datasets."""
    papers = [subset_table(tables.descriptions, tables.published_subsets)]
    for dataset, entry in tables.sources.items():
        notes = [
            f"{title}: {tables.notes[dataset, subset]}"
            for subset, title in SUBSET_TITLES.items()
            if (dataset, subset) in tables.notes
        ]
        notes += with_memory(dataset, tables.sources, tables.frames.get("recorded"))
        table = comparison_table(
            entry.get("paper_table"),
            dataset,
            entry["title"],
            point=tables.frames["point_metrics"],
            cells=tables.frames["published_comparison"],
            model_titles=titles.models,
            notes=notes,
        )
        papers.append(table)
    cells = tables.frames["published_intervals"]
    if len(cells):
        papers.append(table_6(cells, {name: entry["title"] for name, entry in tables.sources.items()}, titles))
    return papers


def _preface(sentences: Sequence[str], presets: Sequence[str]) -> str:
    """The heading, the counts of verdicts, and what the columns are."""
    lines = ["# The paper's Tables 2 to 6 beside ours", "", *(f"- {sentence}" for sentence in sentences), ""]
    columns = "; ".join(["the cell as printed", *(PRESET_COLUMNS[preset] for preset in presets)])
    explanation = (
        f"Each metric has {COUNTS[1 + len(presets)]}: {columns}. A dataset that the paper has no table of has no "
        "printed cells. The best cell of each column is bold. Our numbers have three significant digits. Errors are "
        "averaged over coordinates, constant ones included, as in the paper; `point_metrics.csv` has them without.\n"
    )
    return "\n".join([*lines, explanation])
