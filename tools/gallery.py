"""Write the gallery of docs/results.md: one table and a few pictures of a finished run.

    python -m tools.gallery [--results results] [--page docs/results.md]

Pictures are copied into the folder `gallery` beside the page; the table, its notes and the pictures with their captions
are written between the page's two marks.
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path
from typing import Any

import pandas as pd
from PIL import Image

from softkin.core.errors import DataError, SoftkinError
from softkin.core.files import replacing, write_text
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.data.audit.findings import leak_notes
from softkin.reporting.tables.interval_choice import deployed_intervals
from softkin.reporting.tables.numbers import assessed_text, length_text, share_text
from softkin.training.selection import deployed
from tools.finished_run import TITLES, FinishedRun, page_program, table

#: The page that the gallery is part of.
PAGE = Path("docs") / "results.md"
FOLDER = "gallery"
BEGIN, END = "<!-- gallery: written by `make gallery` -->", "<!-- end of gallery -->"
#: (folder in results/, figure) of each picture; the first leads the README as well.
PICTURES = (
    ("finger", "robot"),
    ("finger_recorded", "time"),
    ("finger", "workspace_predictions"),
    ("finger", "ranking"),
    ("abaqus", "position_curves"),
)
#: Pages are read on telephones as well.
MAX_BYTES = 150_000
MAX_WIDTH = 120
#: Findings of the audit on rows whose positions are wrong.
GROSS_ERRORS = ("stuck_poses", "gross_outliers")


def make_gallery(results: Path, page: Path) -> None:
    """Copy the pictures of `results`, and write the gallery of `page` anew.

    Raises:
        DataError: the run has not made one of the files.
        SoftkinError: the page has no place for the gallery.
    """
    text = page.read_text(encoding="utf-8") if page.is_file() else ""
    if not re.search(f"{re.escape(BEGIN)}.*{re.escape(END)}", text, re.DOTALL):
        raise SoftkinError("no place for the gallery", where=page, fix="write the page first: make results-page")
    run = FinishedRun(results)
    pictures = [_picture(run, dataset, figure, page.parent) for dataset, figure in PICTURES]
    section = "\n\n".join([BEGIN, "## At a glance", robots_table(run), *map(_filled, notes(run)), *pictures, END])
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    write_text(page, before + section + after)


def robots_table(run: FinishedRun) -> str:
    """A Markdown table with a row per robot: the deployed model, its errors, and width and coverage of its intervals.

    The robot of the largest error comes first; those whose test scores leak come last.
    """
    choice = deployed_intervals(run.tables.read("interval_choice"))
    rows = []
    for robot in _deployed(run):
        test, extrapolation = robot["scores"].loc[TEST], robot["scores"].loc[EXTRAPOLATION]
        interval = choice.loc[robot["dataset"]]
        errors = (test["euclidean_p95_mm"], test["euclidean_mean_mm"], extrapolation["euclidean_mean_mm"])
        beyond = assessed_text(interval["extrapolation_coverage"], interval["extrapolation_assessable"])
        cells = [
            *map(length_text, (*errors, interval["test_mean_width_mm"])),
            share_text(interval["test_coverage"]),
            beyond,
        ]
        title = robot["title"] + (" (leak)" if robot["leak"] else "")
        rows.append([title, TITLES.models[robot["model"]], *cells])
    level = share_text(choice["confidence_level"].iloc[0], 0)
    header = ["Robot", "Deployed model", "Marker error on test, 95 % below", "Its mean", "Mean on extrapolation"]
    header += [f"Mean width of its {level} intervals", "Coverage on test", "Coverage on extrapolation"]
    return table(header, rows)


def notes(run: FinishedRun) -> list[str]:
    """What a reader of the table must know: which means a few rows carry, and which scores leak."""
    sentences = []
    for robot in _deployed(run):
        name = run.name(robot["dataset"])
        test = robot["scores"].loc[TEST]
        if test["euclidean_mean_mm"] > test["euclidean_p95_mm"]:
            sentences.append(
                f"*{name}*: a few rows carry the mean on test, which exceeds what 95 % of the errors lie below"
                f"{_gross_errors(run, robot['dataset'])}. Read the 95 % figure."
            )
        if robot["leak"]:
            sentences.append(f"*{name}*: {robot['leak']}")
    return sentences


def _deployed(run: FinishedRun) -> list[dict[str, Any]]:
    """Of each robot dataset, title, deployed model, its scores by subset, and what leaks into test ("" for none)."""
    scores = run.tables.read("point_metrics").set_index(["dataset", "model", "preset", "subset"]).sort_index()
    robots = [
        {
            "dataset": row.dataset,
            "title": run.description(row.dataset)["title"],
            "model": row.model,
            "scores": scores.loc[(row.dataset, row.model, row.preset)],
            "leak": leak_notes(run.card(row.dataset)).get(TEST, ""),
        }
        for row in deployed(run.tables.read("selection")).itertuples()
    ]
    return sorted(robots, key=lambda robot: (bool(robot["leak"]), -robot["scores"].loc[TEST, "euclidean_p95_mm"]))


def _gross_errors(run: FinishedRun, dataset: str) -> str:
    """How many rows of test the data card calls gross errors; empty where it calls none so."""
    findings = [finding for finding in run.card(dataset)["findings"] if finding["code"] in GROSS_ERRORS]
    rows = {row for finding in findings for row in finding["rows"].get(TEST, ())}
    n_rows = run.description(dataset)["rows"][TEST]
    return f": {len(rows)} of its {n_rows} rows are gross errors, such as failed simulations" if rows else ""


def _picture(run: FinishedRun, dataset: str, figure: str, beside: Path) -> str:
    """Copy one picture into the gallery; the Markdown that shows it above its caption."""
    source = run.results / dataset / "figures" / f"{figure}.png"
    for path in (source, source.parent / "index.csv"):
        if not path.is_file():
            raise DataError("no such file", where=path, fix="run the default configuration first: make run")
    index = pd.read_csv(source.parent / "index.csv").drop_duplicates("figure").set_index("figure")
    title, caption = index.loc[figure, ["title", "caption"]]
    target = Path(FOLDER) / f"{dataset}_{figure}.png"
    (beside / FOLDER).mkdir(parents=True, exist_ok=True)
    with Image.open(source) as image, replacing(beside / target) as temporary:
        _save_small(image.convert("RGB"), temporary)
    name = run.name(dataset)
    return f"### {title}: {name}\n\n![{title}, {name}]({target.as_posix()})\n\n{_filled(caption)}"


def _save_small(image: Image.Image, path: Path) -> None:
    """Save at most `MAX_BYTES`: with 256 colours and, where that is not enough, smaller."""
    image.quantize(256, dither=Image.Dither.NONE).save(path, format="png", optimize=True)
    if path.stat().st_size > MAX_BYTES:
        _save_small(image.resize((image.width * 9 // 10, image.height * 9 // 10), Image.Resampling.LANCZOS), path)


def _filled(text: str) -> str:
    return textwrap.fill(text, MAX_WIDTH, break_long_words=False, break_on_hyphens=False)


def main() -> int:
    """Print the error, if any; return the exit status."""
    return page_program(make_gallery, PAGE, __doc__)


if __name__ == "__main__":
    sys.exit(main())
