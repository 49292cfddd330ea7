"""The gallery of the README: a few pictures and one table of a finished run.

    python -m softkin.gallery [--results results] [--readme README.md]

copies the pictures into docs/gallery beside the README, and writes table and pictures between its two marks.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

import pandas as pd
from PIL import Image

from softkin.core.errors import SoftkinError
from softkin.core.files import read_json, replacing, write_text
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.data.audit.findings import leaking_subsets
from softkin.models import MODELS
from softkin.reporting.tables.interval_choice import given_intervals
from softkin.reporting.tables.paper_layout import PaperTable, format_number
from softkin.training.selection import deployed

#: What is shown, two side by side: (folder in results/, figure).
PICTURES = (
    ("abaqus", "robot"),
    ("finger", "ranking"),
    ("abaqus", "position_curves"),
    ("finger", "believed"),
)
#: A README is read on telephones as well.
MAX_BYTES = 150_000
BEGIN, END = "<!-- gallery: written by `make gallery` -->", "<!-- end of gallery -->"
FOLDER = Path("docs") / "gallery"


def make_gallery(results: Path, readme: Path) -> None:
    """Copy the pictures of `results`, and write the section of `readme` anew.

    Raises:
        SoftkinError: the run has not made one of the files, or the README has no place for the gallery.
    """
    text = readme.read_text(encoding="utf-8")
    if not re.search(f"{re.escape(BEGIN)}.*{re.escape(END)}", text, re.DOTALL):
        raise SoftkinError(f"{readme}: no place for the gallery\n  mend: write the lines '{BEGIN}' and '{END}' into it")
    cells = [_picture(results, folder, figure, readme.parent) for folder, figure in PICTURES]
    rows = [f"| {left} | {right} |" for left, right in zip(cells[::2], cells[1::2], strict=True)]
    section = "\n".join([BEGIN, robots_table(results).markdown(), rows[0], "| --- | --- |", *rows[1:], END])
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    write_text(readme, before + section + after)


def robots_table(results: Path) -> PaperTable:
    """Per robot the chosen model, its errors, and how often its intervals hold `test`."""
    tables = {name: pd.read_csv(_made(results / "tables" / f"{name}.csv")) for name in ("selection", "point_metrics")}
    choice = pd.read_csv(_made(results / "tables" / "interval_choice.csv"))
    scores = tables["point_metrics"]
    scores = scores.set_index(["dataset", "model", "preset", "subset"])
    rows = []
    for robot in deployed(tables["selection"]).itertuples():
        about = read_json(_made(results / robot.dataset / "dataset.json"))
        leaks = leaking_subsets(read_json(_made(results / robot.dataset / "data_card.json")))
        test, outside = (
            scores.loc[(robot.dataset, robot.model, robot.preset, subset)] for subset in (TEST, EXTRAPOLATION)
        )
        interval = given_intervals(choice).loc[robot.dataset]
        errors = (test["euclidean_mean_mm"], test["euclidean_p95_mm"], outside["euclidean_mean_mm"])
        rows.append(
            [
                about["title"] + (" (LEAK: test rows stand in train)" if TEST in leaks else ""),
                MODELS[robot.model].title,
                *map(format_number, errors),
                format_number(interval["test_mean_width_mm"]),
                f"{interval['test_coverage']:.1%}",
                f"{interval['extrapolation_coverage']:.1%}",
            ]
        )
    level = f"{choice['confidence_level'].iloc[0]:.0%}"
    header = ["Robot", "Chosen model", "Mean error of a marker, test (mm)", "95 % below (mm)", "Extrapolation (mm)"]
    header += [f"Width of its {level} intervals (mm)", "They cover, test", "Extrapolation"]
    return PaperTable("What a run ends with", header, rows, set(), [("", len(rows))])


def _picture(results: Path, folder: str, figure: str, beside: Path) -> str:
    """Copy one picture; the cell of Markdown that shows it."""
    source = _made(results / folder / "figures" / f"{figure}.png")
    index = pd.read_csv(_made(source.parent / "index.csv")).set_index("figure")
    title = index["title"].get(figure, figure)
    title = title if isinstance(title, str) else title.iloc[0]  # a row for each run that the figure shows
    target = FOLDER / f"{folder}_{figure}.png"
    (beside / FOLDER).mkdir(parents=True, exist_ok=True)
    with Image.open(source) as image, replacing(beside / target) as temporary:
        _save_small(image.convert("RGB"), temporary)
    return f"![{title}, {folder}]({target.as_posix()})"


def _save_small(image: Image.Image, path: Path) -> None:
    """At most `MAX_BYTES`: with 256 colours and, where that is not enough, smaller."""
    image.quantize(256, dither=Image.Dither.NONE).save(path, format="png", optimize=True)
    if path.stat().st_size > MAX_BYTES:
        _save_small(image.resize((image.width * 9 // 10, image.height * 9 // 10), Image.Resampling.LANCZOS), path)


def _made(path: Path) -> Path:
    if not path.is_file():
        raise SoftkinError(f"{path} is not there\n  mend: run the default configuration first: make run")
    return path


def main() -> int:
    """Print the error, if any; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--readme", type=Path, default=Path("README.md"))
    options = parser.parse_args()
    try:
        make_gallery(options.results, options.readme)
    except SoftkinError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
