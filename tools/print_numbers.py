"""Print what the tables of a run of the default configuration say, section by section.

    python -m tools.print_numbers [--results results]

Reads results/tables of a finished run and writes nothing: `diff` of two such prints tells whether a number changed.
Coverage over re-splits is `make coverage`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd

from softkin.core.runs import OUTER
from softkin.core.samples import EXTRAPOLATION, TEST
from tools.run_tables import ONE_FOR_EVERYWHERE, RUN, RunTables

RATIO = "winkler_ratio_to_oracle"


def section(title: str, *frames: pd.DataFrame | pd.Series | str) -> None:
    """Print a title, and what belongs below it."""
    print(f"\n## {title}")
    for frame in frames:
        print(frame if isinstance(frame, str) else frame.to_string(float_format=lambda value: f"{value:.3g}"))


def printed_cells(tables: RunTables) -> None:
    """Print how many printed cells are reproduced or beaten, and which are not."""
    cells, columns = tables.read("published_comparison"), tables.read("published_columns")
    key = ["dataset", "subset", "model", "metric", "printed"]
    off = cells.loc[cells["paper_verdict"] != "reproduced", [*key, "paper_value"]]
    not_beaten = cells.loc[cells["tuned_verdict"] != "better", [*key, "tuned_value", "outer_value", "tuned_verdict"]]
    section(
        "printed cells",
        cells["paper_verdict"].value_counts(),
        off,
        cells["tuned_verdict"].value_counts(),
        not_beaten,
        columns["verdict"].value_counts(),
    )


def points_in_extrapolation(tables: RunTables) -> None:
    """Print the deployed models' errors in extrapolation, and what target spaces are worth."""
    section("deployed, on extrapolation", tables.deployed_in_extrapolation())
    section("studies by target space", tables.read("searched_runs")["target_space"].value_counts())
    ratios = tables.space_ratios()
    gains = int((ratios < 1).sum().sum())
    section("curvature over Cartesian, extrapolation RMSE", ratios, f"less than 1 in {gains} of {ratios.size}")
    section("the forest on extrapolation", tables.errors_by_preset("rf"))


def intervals_in_domain(tables: RunTables) -> None:
    """Print what intervals hold where something is promised."""
    section("intervals chosen", tables.chosen_intervals())
    section("around the paper's GB", tables.papers_intervals())
    section("the Gaussian process' own", tables.gaussian_process_intervals())
    section("jointly, deployed", tables.joint_coverage())
    section("alarms, deployed", tables.alarms())


def intervals_in_extrapolation(tables: RunTables) -> None:
    """Print what intervals hold in extrapolation, beside the oracle."""
    frame = tables.at_level("extrapolation_intervals")
    run = [*RUN, "interval_method"]
    columns = ["coverage", RATIO, "infinite_share", "domain_auc", "effective_size", "refused"]
    plain = [ONE_FOR_EVERYWHERE, "scp_mapie"]
    for subset in (EXTRAPOLATION, TEST):
        rows = frame[(frame["subset"] == subset) & frame["interval_method"].isin(plain)]
        shown = [
            "coverage",
            "worst_coverage",
            "joint_coverage",
            RATIO,
            "ratio_low",
            "ratio_high",
            "ratio_without_gross",
        ]
        section(f"auto and plain, {subset}", rows.set_index(run)[[*shown, "n_commands", "assessable"]])
    others = frame[(frame["subset"] == EXTRAPOLATION) & ~frame["interval_method"].isin(plain)]
    section("everything else, extrapolation", others[others["preset"] != OUTER].set_index(run)[columns])


def main() -> None:
    """Print every section."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=Path("results"))
    tables = RunTables(parser.parse_args().results / "tables")
    printed_cells(tables)
    points_in_extrapolation(tables)
    intervals_in_domain(tables)
    intervals_in_extrapolation(tables)


if __name__ == "__main__":
    main()
