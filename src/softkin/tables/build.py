"""All tables of results/tables, from the scores of every dataset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from softkin.files import read_json, replacing, write_text
from softkin.findings import LEAK, leaking_subsets
from softkin.interface import TEST, TUNED
from softkin.tables.headline import headline
from softkin.tables.interval_choice import interval_choice
from softkin.tables.interval_layout import interval_table
from softkin.tables.leaks import marked
from softkin.tables.paper_layout import SUBSET_TITLES, PaperTable, comparison_table, subset_table
from softkin.tables.published import compare, compare_columns, read_published, summary
from softkin.tables.published_intervals import compare_intervals, read_published_intervals, table_6
from softkin.tables.selection import deployed, foretold, searched_runs, selection


def build_tables(
    *,
    point: Sequence[str | Path],
    markers: Sequence[str | Path],
    intervals: Sequence[str | Path],
    choices: Mapping[str, str | Path],
    conditional: Sequence[str | Path],
    alarms: Sequence[str | Path],
    outside: Sequence[str | Path],
    spaces: Sequence[str | Path],
    descriptions: Sequence[str | Path],
    data_cards: Sequence[str | Path],
    parameters: Sequence[str | Path],
    studies: Sequence[tuple[str, str, str]],
    objective: str,
    sources: Mapping[str, Mapping[str, Any]],
    model_titles: Mapping[str, str],
    published: str | Path,
    published_subsets: str | Path,
    published_intervals: str | Path,
    interval_titles: Mapping[str, str],
    folder: Path,
) -> None:
    """Write every table into `folder`.

    `point`, `markers`, `intervals`, `conditional`, `alarms`, `outside`, `spaces`, `descriptions` and `data_cards`
    hold one file per dataset, `choices` is dataset -> file; `parameters` one per (dataset, model, preset) of `studies`,
    or none when nothing was searched; `objective` is what the deployed models are chosen for; `sources` are the
    datasets' entries of config/datasets.yaml.
    """
    abouts = [read_json(path) for path in descriptions]
    cards = [read_json(path) for path in data_cards]
    leaks = {card["dataset"]: leaking_subsets(card) for card in cards}
    scores, per_marker = (marked(_together(paths), leaks) for paths in (point, markers))
    notes = _notes(sources, abouts, cards)
    cells = compare(read_published(published), scores, notes)
    columns = compare_columns(cells, scores) if f"{TUNED}_value" in cells else None
    chosen = best = None
    if parameters:
        searched = searched_runs(dict(zip(studies, parameters, strict=True)))
        chosen = selection(searched, objective)
        best = deployed(chosen)

    interval_scores = marked(_together(intervals), leaks, calibrated=True)
    interval_cells = compare_intervals(read_published_intervals(published_intervals), interval_scores, scores)

    candidates = interval_choice({name: pd.read_csv(path) for name, path in choices.items()}, interval_scores)
    chosen_intervals = marked(candidates, leaks, calibrated=True)

    frames = {"point_metrics": scores, "marker_errors": per_marker, "published_comparison": cells}
    frames |= {"interval_metrics": interval_scores, "published_intervals": interval_cells}
    frames["interval_choice"] = chosen_intervals
    per_dataset = {"conditional_coverage": conditional, "alarm_rates": alarms, "extrapolation_intervals": outside}
    for name, paths in per_dataset.items():
        frames[name] = marked(_together(paths), leaks, calibrated=True)
    frames["target_spaces"] = marked(_together(spaces), leaks)
    frames |= {} if columns is None else {"published_columns": columns}
    frames |= {} if chosen is None else {"selection": chosen, "searched_runs": foretold(searched, scores)}
    for name, frame in frames.items():
        with replacing(folder / f"{name}.csv") as temporary:
            frame.to_csv(temporary, index=False)

    laid_out = [subset_table(abouts, pd.read_csv(published_subsets))]
    laid_out += _comparisons(scores, cells, notes, sources, model_titles)
    titles = {name: entry["title"] for name, entry in sources.items()}
    if len(interval_cells):
        laid_out.append(table_6(interval_cells, titles, dict(interval_titles)))
    sentences = summary(cells, columns)
    leaking = [card["dataset"] for card in cards if card["is_leaking"]]
    write_text(folder / "paper_tables.md", "\n".join([_preface(sentences), *(table.markdown() for table in laid_out)]))
    write_text(folder / "paper_tables.tex", "\n".join(table.latex() for table in laid_out))
    remarks = [f"{titles[dataset]}, {subset}: {note}" for (dataset, subset), note in notes.items() if subset == TEST]
    ours = interval_table(interval_scores, chosen_intervals, titles, model_titles, interval_titles, remarks)
    write_text(folder / "interval_tables.md", ours.markdown())
    write_text(folder / "interval_tables.tex", ours.latex())
    write_text(folder / "headline.txt", headline(best, scores, chosen_intervals, sentences, leaking))


def _together(paths: Sequence[str | Path]) -> pd.DataFrame:
    return pd.concat([pd.read_csv(path) for path in paths], ignore_index=True)


def _notes(
    sources: Mapping[str, Mapping[str, Any]], abouts: Sequence[Mapping[str, Any]], cards: Sequence[Mapping[str, Any]]
) -> dict[tuple[str, str], str]:
    """What a reader must know, by (dataset, subset): the entries' notes, leaks, and that rows were left out."""
    found = [
        ((name, subset), note) for name, entry in sources.items() for subset, note in entry.get("notes", {}).items()
    ]
    found += [
        ((card["dataset"], subset), f"LEAK: {finding['sentence']} {finding['consequence']}")
        for card in cards
        for finding in card["findings"]
        if finding["severity"] == LEAK
        for subset in finding["subsets"]
    ]
    warning = "Not comparable with the paper: max_rows_per_subset left rows out."
    found += [((about["dataset"], subset), warning) for about in abouts if about["is_cut"] for subset in SUBSET_TITLES]
    notes: dict[tuple[str, str], str] = {}
    for key, note in found:
        notes[key] = f"{notes.get(key, '')} {note}".strip()
    return notes


def _comparisons(
    scores: pd.DataFrame,
    cells: pd.DataFrame,
    notes: Mapping[tuple[str, str], str],
    sources: Mapping[str, Mapping[str, Any]],
    model_titles: Mapping[str, str],
) -> list[PaperTable]:
    tables = []
    for dataset, entry in sources.items():
        remarks = [f"{SUBSET_TITLES[s]}: {notes[dataset, s]}" for s in SUBSET_TITLES if (dataset, s) in notes]
        number = entry.get("paper_table")
        tables.append(comparison_table(number, dataset, entry["title"], scores, cells, model_titles, remarks))
    return tables


def _preface(sentences: Sequence[str]) -> str:
    lines = ["# The paper's Tables 2 to 6 beside ours", "", *(f"- {sentence}" for sentence in sentences), ""]
    explanation = (
        "Each metric has three columns: the cell as printed, our paper preset (the paper's settings), our tuned "
        "preset. The best cell of each column is bold. Errors are averaged over coordinates, those that never move "
        "included, as the paper does; `point_metrics.csv` has the same without them.\n"
    )
    return "\n".join([*lines, explanation])
