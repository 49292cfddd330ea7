"""Write docs/claims.md: every claim of the paper with the verdict of a finished run of the default configuration.

    python -m tools.claims_page [--results results] [--page docs/claims.md]

All of it but this text comes from `results/tables/claims.csv`.
"""

from __future__ import annotations

import sys
from pathlib import Path

from softkin.core.files import write_text
from softkin.reporting.claims.spec import VERDICTS
from softkin.reporting.claims.table import VERDICT_TURNS
from tools.finished_run import page_program, table
from tools.results_page import wrapped
from tools.run_tables import RunTables

HEAD = """# Claims of the paper

Every claim of *Data-driven Kinematic Modeling in Soft Robots* (Jiang, Shah, Yang, Sarkar), in the order of the paper.
This page is made by `make results-page` from a finished run of the default configuration (`results/tables/claims.csv`);
no verdict in it is written by hand. Each claim has one rule, in `src/softkin/reporting/claims`, which is the same for
every run; what was known when the rules were written is said in
[decision 0032](decisions/0032-claims-have-rules.md).

- *Holds with these settings*: with some of the presets, regimes or columns that are named, and not with the others.
  `paper` are the paper's settings, `tuned` and `outer` those that searches on `train` found.
- Places are a dataset and a subset. Where commands of a subset stand in `train`, or it has too few distinct commands,
  it is no place: of ELASTICA, the corrected revision 2023-09 speaks.
- *One row decides*: with that single row of `test` or `extrapolation` left out (counted from 0 within its subset), the
  verdict or the comparison would be another."""


def make_claims_page(results: Path, page: Path) -> None:
    """Write the page from the run in `results`.

    Raises:
        DataError: the run has not made the table.
    """
    claims = RunTables(results / "tables").read("claims").fillna("")
    counts = "; ".join(f"{(claims['verdict'] == verdict).sum()} {verdict}" for verdict in VERDICTS)
    overview = table(
        ["Claim", "Where", "Verdict", "With", "One row decides the verdict"],
        (
            [
                *(f"[{row.text}](#{row.claim})", row.where, f"**{row.verdict}**", row.settings),
                "yes" if VERDICT_TURNS in row.decided_by else "no",
            ]
            for row in claims.itertuples()
        ),
    )
    sections = [_section(row._asdict()) for row in claims.itertuples(index=False)]
    text = "\n\n".join([HEAD, f"Of {len(claims)} claims: {counts}.", overview, *sections])
    write_text(page, wrapped(text) + "\n")


def _section(row: dict[str, str]) -> str:
    """One claim: what is said, the verdict, what is compared, the numbers, rows that decide."""
    with_these = f" ({row['settings']})" if row["settings"] else ""
    lines = [f"## {row['claim']}", f'"{row["text"]}" ({row["where"]}): **{row["verdict"]}**{with_these}.']
    lines.append(f"- Compared is: {row['rule']}.")
    lines.append(f"- Numbers: {row['numbers']}.")
    if row["decided_by"]:
        lines.append(f"- One row decides: {row['decided_by']}.")
    if row["table"]:
        lines.append(f"- From `{row['table']}`, by `{row['command']}`.")
    return "\n\n".join([*lines[:2], "\n".join(lines[2:])])


def main() -> int:
    """Print the error, if any; return the exit status."""
    return page_program(make_claims_page, Path("docs") / "claims.md", __doc__)


if __name__ == "__main__":
    sys.exit(main())
