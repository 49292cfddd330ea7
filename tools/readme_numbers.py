"""What the tables of a run of the default configuration say for the README, section by section.

    python benchmarks/readme_numbers.py

Reads results/tables of a finished run; prints, writes nothing. Coverage over re-splits is `make coverage`.
"""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from softkin.core.runs import OUTER, PAPER, TUNED
from softkin.core.samples import EXTRAPOLATION, TEST

TABLES = Path(__file__).parent.parent / "results" / "tables"
LEVEL = 0.9


def table(name: str) -> pd.DataFrame:
    """A table of the run."""
    return pd.read_csv(TABLES / f"{name}.csv")


def section(title: str, *frames: pd.DataFrame | pd.Series | str) -> None:
    """A title, and what belongs below it."""
    print(f"\n## {title}")
    for frame in frames:
        print(frame if isinstance(frame, str) else frame.to_string(float_format=lambda value: f"{value:.3g}"))


def published() -> None:
    """How many printed cells hold, and which do not."""
    cells, columns = table("published_comparison"), table("published_columns")
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


def outside() -> None:
    """The deployed models, and what target spaces are worth."""
    selection, scores = table("selection"), table("point_metrics")
    run = ["dataset", "model", "preset"]
    deployed = selection.loc[selection["deployed"], [*run, "target_space"]]
    errors = scores.loc[scores["subset"] == EXTRAPOLATION, [*run, "rmse_mm", "mae_mm"]]
    ranks = table("searched_runs").groupby("dataset")[["shell_rank_correlation", "cv_rank_correlation"]].first()
    section("deployed, on extrapolation", deployed.merge(errors, on=run).merge(ranks, on="dataset"))
    chosen = table("searched_runs")
    section("studies by target space", chosen["target_space"].value_counts())
    spaces = table("target_spaces")
    wide = spaces[spaces["subset"] == EXTRAPOLATION].pivot_table(
        index="model", columns=["dataset", "target_space"], values="rmse_mm", sort=False
    )
    names = spaces["dataset"].unique()
    ratios = pd.DataFrame({name: wide[name, "curvature"] / wide[name, "cartesian"] for name in names})
    gains = int((ratios < 1).sum().sum())
    section("curvature over Cartesian, extrapolation RMSE", ratios, f"less than 1 in {gains} of {ratios.size}")
    forest = scores[(scores["subset"] == EXTRAPOLATION) & (scores["model"] == "rf")]
    section("the forest on extrapolation", forest.pivot_table(index="dataset", columns="preset", values="rmse_mm"))


def inside() -> None:
    """What intervals hold where something is promised."""
    choice = table("interval_choice")
    names = ["dataset", "model", "preset", "interval_method", "chosen", "deployed"]
    shown = choice[choice["chosen"] | choice["deployed"]]
    section("intervals chosen", shown[[*names, "test_coverage", "test_winkler_mm", "winkler_ratio_to_paper"]])
    metrics = table("interval_metrics")
    metrics = metrics[metrics["confidence_level"] == LEVEL]
    run = ["dataset", "subset", "interval_method"]
    means = metrics[metrics["coordinate"] == "mean_informative"]
    papers = means[(means["model"] == "gb") & (means["preset"] == PAPER)]
    papers = papers[papers["interval_method"].isin(["qr", "cqr", "scp_mapie"])]
    section("around the paper's GB", papers.set_index(run)[["coverage", "winkler_mm"]])
    process = means[(means["model"] == "gp") & (means["preset"] == TUNED) & (means["interval_method"] == "gaussian")]
    section("the Gaussian process' own", process.set_index(run)[["coverage"]])
    selection = table("selection")
    deployed = selection.loc[selection["deployed"], ["dataset", "model", "preset"]]
    jointly = metrics[(metrics["coordinate"] == "joint") & (metrics["subset"] == TEST)]
    section("jointly, deployed", deployed.merge(jointly)[["dataset", "interval_method", "coverage", "size_mm"]])
    alarms = table("alarm_rates").merge(deployed)
    alarms = alarms[(alarms["alpha"].round(6) == round(1 - LEVEL, 6)) & (alarms["subset"] == TEST)]
    columns = ["dataset", "displacement_mm", "n_rows", "joint_alarm_rate", "joint_low", "joint_high"]
    section("alarms, deployed", alarms[columns])


def intervals_outside() -> None:
    """Intervals on extrapolation, beside the oracle."""
    frame = table("extrapolation_intervals")
    frame = frame[frame["confidence_level"] == LEVEL]
    run = ["dataset", "model", "preset", "interval_method"]
    columns = ["coverage", "winkler_ratio_to_oracle", "infinite_share", "domain_auc", "effective_size", "refused"]
    for subset in (EXTRAPOLATION, TEST):
        rows = frame[(frame["subset"] == subset) & frame["interval_method"].isin(["auto", "scp_mapie"])]
        section(f"auto and plain, {subset}", rows.set_index(run)[columns[:2]])
    others = frame[(frame["subset"] == EXTRAPOLATION) & ~frame["interval_method"].isin(["auto", "scp_mapie"])]
    section("everything else, extrapolation", others[others["preset"] != OUTER].set_index(run)[columns])


if __name__ == "__main__":
    published()
    outside()
    inside()
    intervals_outside()
