"""Lay out Tables 2 to 5 as the paper does, as Markdown and as LaTeX (booktabs)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from softkin.core.escaping import latex_text, markdown_text
from softkin.core.metrics.point import LARGER_IS_BETTER
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.core.units import MM
from softkin.reporting.tables.numbers import NOTHING, number_text
from softkin.reporting.units import units_in

HEADINGS = {"rmse_mm": "RMSE (mm)", "mae_mm": "MAE (mm)", "r2": "R2", "mape_percent": "MAPE (%)"}
#: As the paper heads its tables.
SUBSET_TITLES = {TEST: "Testing", EXTRAPOLATION: "Extrapolation"}


@dataclass(frozen=True, slots=True)
class PaperTable:
    """A titled grid of text; `bold` marks cells, `notes` go below, `groups` are (heading, number of rows)."""

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    bold: set[tuple[int, int]]
    groups: Sequence[tuple[str, int]]
    notes: Sequence[str] = ()

    def markdown(self) -> str:
        """As a Markdown table, group headings as rows of their own."""
        lines = [
            f"### {markdown_text(self.title)}",
            "",
            _line(map(markdown_text, self.header)),
            _line(["---"] * len(self.header)),
        ]
        start = 0
        for heading, size in self.groups:
            if heading:
                lines.append(_line([f"*{markdown_text(heading)}*"] + [""] * (len(self.header) - 1)))
            lines += [_line(self._cells(i, "**{}**", markdown_text)) for i in range(start, start + size)]
            start += size
        return "\n".join([*lines, "", *(f"{markdown_text(note)}\n" for note in self.notes)])

    def latex(self) -> str:
        """As a LaTeX table environment; needs the package booktabs."""
        n = len(self.header)
        lines = [r"\begin{table}[hb]", r"\centering", rf"\caption{{{_tex(self.title)}}}"]
        lines += [rf"\begin{{tabular}}{{l{'r' * (n - 1)}}}", r"\toprule", _tex_line(map(_tex, self.header))]
        start = 0
        for heading, size in self.groups:
            lines.append(r"\midrule")
            if heading:
                lines.append(rf"\multicolumn{{{n}}}{{l}}{{\emph{{{_tex(heading)}}}}} \\")
            for i in range(start, start + size):
                lines.append(_tex_line(self._cells(i, r"\textbf{{{}}}", _tex)))
            start += size
        lines += [r"\bottomrule", r"\end{tabular}", *(rf"\par\small {_tex(note)}" for note in self.notes)]
        return "\n".join([*lines, r"\end{table}", ""])

    def _cells(self, row: int, bold: str, escape: Callable[[str], str]) -> list[str]:
        return [
            bold.format(escape(cell)) if (row, column) in self.bold else escape(cell)
            for column, cell in enumerate(self.rows[row])
        ]


def subset_table(descriptions: Sequence[Mapping[str, object]], published: pd.DataFrame) -> PaperTable:
    """Table 2: rows, input and output features of each subset, ours and as printed."""
    printed = {(row.dataset, row.subset): row.n_rows for row in published.itertuples()}
    rows, groups = [], []
    for description in descriptions:
        sizes: Mapping[str, int] = description["rows"]  # type: ignore[assignment]
        features = [str(description["n_commands"]), str(3 * int(str(description["n_markers"])))]
        for subset, size in sizes.items():
            rows.append([subset, str(size), str(printed.get((description["dataset"], subset), NOTHING)), *features])
        groups.append((str(description["title"]), len(sizes)))
    header = ["Subset", "Size", "Size in the paper", "Input features", "Output features"]
    return PaperTable("Table 2: data description", header, rows, set(), groups)


def comparison_table(
    number: int | None,
    dataset: str,
    title: str,
    *,
    point: pd.DataFrame,
    cells: pd.DataFrame,
    model_titles: Mapping[str, str],
    notes: Sequence[str],
) -> PaperTable:
    """Tables 3 to 5: a row per model, test above extrapolation; for each metric the printed cell, then every preset.

    The best cell of each column is bold.

    Parameters:
        number: of the paper's table; None for a dataset that the paper has no table of.
        dataset: its name.
        title: its title.
        point: the point metrics of all datasets, as in point_metrics.csv.
        cells: the printed cells beside ours, as in published_comparison.csv.
        model_titles: model -> title.
        notes: sentences below the table.
    """
    sources = [*(["printed"] if number else []), *presets_of(point)]
    unit = units_in(point).get(dataset, MM)
    headings = [heading.replace("(mm)", f"({unit})") for heading in HEADINGS.values()]
    header = ["Method", *(f"{heading} {source}" for heading in headings for source in sources)]
    rows: list[list[str]] = []
    bold: set[tuple[int, int]] = set()
    groups = []
    for subset, subset_title in SUBSET_TITLES.items():
        start = len(rows)
        scores = point[(point["dataset"] == dataset) & (point["subset"] == subset)]
        printed = cells[(cells["dataset"] == dataset) & (cells["subset"] == subset)]
        models = list(dict.fromkeys(scores["model"]))
        rows += [[model_titles[model]] for model in models]
        for metric in HEADINGS:
            for source in sources:
                if source == "printed":
                    texts = printed[printed["metric"] == metric].set_index("model")["printed"].to_dict()
                    values = {model: float(text) for model, text in texts.items()}
                else:
                    values = scores[scores["preset"] == source].set_index("model")[metric].to_dict()
                    texts = {model: number_text(value) for model, value in values.items()}
                best = (max if LARGER_IS_BETTER[metric] else min)(values.values(), default=None)
                for offset, model in enumerate(models):
                    if model in values and texts[model] == text_of_best(best, texts, values):
                        bold.add((start + offset, len(rows[start + offset])))
                    rows[start + offset].append(texts.get(model, NOTHING))
        groups.append((subset_title, len(models)))
    heading = f"Table {number}: comparison on {title}" if number else f"Comparison on {title} (not in the paper)"
    return PaperTable(heading, header, rows, bold, groups, notes)


def presets_of(point: pd.DataFrame) -> list[str]:
    """The presets that were run, in the order of the configuration."""
    return list(dict.fromkeys(point["preset"]))


def text_of_best(best: float | None, texts: Mapping[str, str], values: Mapping[str, float]) -> str | None:
    """The text of the best value: cells that read the same are equally best."""
    return next((texts[model] for model, value in values.items() if value == best), None)


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _tex_line(cells: Iterable[str]) -> str:
    return " & ".join(cells) + r" \\"


def _tex(text: str) -> str:
    return latex_text(text).replace("R2", "$R^2$")
