"""Which numbers of a finished run hang on a single row of `test` or `extrapolation`, or on a single coordinate.

    python -m tools.single_rows [--results results] [--share 0.05]

From stored predictions and intervals, errors of the deployed runs, scores of intervals around them and ratios to the
paper's recipe are computed once more with each single row left out, R2 with each single coordinate. Printed are those
that change by more than the share, with the row that changes them most; then which verdicts on the paper's claims would
be others. The exit status is 1 where a verdict would.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.errors import SoftkinError
from softkin.core.runs import Run
from softkin.evaluation.score_left_out import score_left_out
from softkin.reporting.claims import CLAIMS
from softkin.reporting.claims.measured import measured
from softkin.reporting.claims.table import VERDICT_TURNS, claims_table
from softkin.reporting.tables.numbers import number_text, share_text
from softkin.reporting.tables.single_rows import SHARE, hanging
from softkin.uncertainty.choose import shown_runs
from tools.finished_run import FinishedRun, table

PUBLISHED = Path(__file__).parents[1] / "resources" / "published"


def left_out_of(run: FinishedRun) -> pd.DataFrame:
    """Scores with single rows left out, of all datasets of a run, as in left_out.csv."""
    parts = []
    for dataset in run.datasets:
        folder = run.results / dataset
        intervals = {path.stem: path for path in sorted((folder / "intervals").glob("*.parquet"))}
        with tempfile.TemporaryDirectory() as place:
            output = Path(place) / "left_out.csv"
            score_left_out(
                folder / "table.parquet",
                dataset=dataset,
                predictions={Run(*path.parts[-3:-1]): path for path in sorted(folder.glob("*/*/predictions.parquet"))},
                intervals=intervals,
                shown=shown_runs(folder / "interval_choice.csv"),
                confidence_levels=[run.tables.level],
                output=output,
            )
            parts.append(read_csv(output, dtype={"interval_method": str}).fillna({"interval_method": ""}))
    return pd.concat(parts, ignore_index=True)


def numbers(run: FinishedRun, left_out: pd.DataFrame, share: float) -> list[list[str]]:
    """Dataset, subset, number, value, what it hangs on, value without it, change: of the deployed runs."""
    deployed = {(row.dataset, row.model, row.preset) for row in run.tables.deployed().itertuples()}
    choice = run.tables.chosen_intervals()
    deployed |= {(row.dataset, row.model, row.preset) for row in choice.itertuples()}
    rows = []
    for key, what in hanging(left_out, share).items():
        if (key.dataset, key.model, key.preset) in deployed:
            name = " ".join(filter(None, (key.metric, key.interval_method, "around" * bool(key.interval_method))))
            number = f"{name} {key.model} {key.preset}"
            change = share_text(what.without / what.value - 1)
            rows.append(
                [
                    *(key.dataset, key.subset, number, number_text(what.value), what.left_out),
                    *(number_text(what.without), change),
                ]
            )
    return rows


def verdicts(run: FinishedRun, left_out: pd.DataFrame) -> list[list[str]]:
    """Claim, verdict, and what turns it."""
    names = [path.stem for path in (run.results / "tables").glob("*.csv")]
    frames = {name: run.tables.read(name, "printed") for name in names}
    frames |= {name: read_csv(PUBLISHED / f"{name}.csv") for name in ("subsets", "approaches", "improvements")}
    about, cards = ([of(dataset) for dataset in run.datasets] for of in (run.description, run.card))
    claims = claims_table(CLAIMS, measured(frames, about, cards), left_out)
    turned = claims[claims["decided_by"].str.contains(VERDICT_TURNS)]
    return [[row.claim, row.verdict, row.decided_by] for row in turned.itertuples()]


def main() -> int:
    """Print both tables; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--share", type=float, default=SHARE)
    options = parser.parse_args()
    run = FinishedRun(options.results)
    try:
        left_out = left_out_of(run)
        of_numbers, of_verdicts = numbers(run, left_out, options.share), verdicts(run, left_out)
    except SoftkinError as error:
        print(error, file=sys.stderr)
        return 2
    print(f"Numbers that change by more than {options.share:.0%} without one row or coordinate: {len(of_numbers)}\n")
    print(table(["dataset", "subset", "number", "is", "without", "it is", "change"], of_numbers))
    print(f"\nVerdicts that one row turns: {len(of_verdicts)} of {len(CLAIMS)}\n")
    print(table(["claim", "verdict", "turned"], of_verdicts))
    return 1 if of_verdicts else 0


if __name__ == "__main__":
    sys.exit(main())
