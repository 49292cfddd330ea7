from __future__ import annotations

import pandas as pd

from softkin.reporting.tables.published import compare, compare_columns, read_published, summary
from tests.conftest import HOUSE

PUBLISHED = read_published(HOUSE / "resources" / "published" / "point_metrics.csv")
PAPER = {
    ("abaqus", "test", "lr", "rmse_mm"): "2.89",
    ("abaqus", "extrapolation", "gp", "r2"): "0.972",
    ("elastica", "test", "xgb", "mape_percent"): "2.53e-3",
    ("finger", "extrapolation", "mlp", "mape_percent"): "39.54",
    ("finger", "extrapolation", "xgb", "r2"): "-0.312",
}


def test_all_192_printed_cells_are_here() -> None:
    assert len(PUBLISHED) == 192
    assert not PUBLISHED["printed"].isna().any()
    printed = PUBLISHED.set_index(["dataset", "subset", "model", "metric"])["printed"]
    for key, text in PAPER.items():
        assert printed[key] == text


def scores(**changes: float) -> pd.DataFrame:
    rows = []
    for preset, factor in (("paper", 1.0), ("tuned", 0.5)):
        for model in ("lr", "gp"):
            row = {"rmse_mm": 10.10 * factor, "mae_mm": 9.30 * factor, "r2": 0.5, "mape_percent": 114.73 * factor}
            row = row | (changes if preset == "tuned" else {})
            rows.append({"dataset": "finger", "subset": "extrapolation", "model": model, "preset": preset} | row)
    return pd.DataFrame(rows)


def test_cells_are_compared_preset_by_preset() -> None:
    cells = compare(PUBLISHED, scores(), {("finger", "extrapolation"): "far out"})
    assert len(cells) == 8
    lr = cells[(cells["model"] == "lr") & (cells["metric"] == "rmse_mm")].iloc[0]
    assert (lr["printed"], lr["paper_value"], lr["paper_verdict"]) == ("10.10", 10.10, "reproduced")
    assert (lr["tuned_value"], lr["tuned_verdict"], lr["note"]) == (5.05, "better", "far out")


def test_the_best_of_a_column_faces_the_papers_best_among_the_models_that_were_run() -> None:
    columns = compare_columns(compare(PUBLISHED, scores(), {}), scores()).set_index("metric")
    assert columns.loc["rmse_mm", "printed"] == "10.09"
    assert columns.loc["rmse_mm", "printed_model"] == "gp"
    assert set(columns["verdict"]) == {"better"}
    bad = scores(mape_percent=200.0)
    worse = compare_columns(compare(PUBLISHED, bad, {}), bad).set_index("metric")
    assert worse.loc["mape_percent", "verdict"] == "worse"
    counts = summary(compare(PUBLISHED, scores(), {}), columns)
    assert counts[-1].startswith("tuned preset: 4 of 4 columns")
    # A model that the paper does not have is one of ours.
    huber = bad[bad["model"] == "gp"].assign(model="huber", mape_percent=100.0)
    pool = pd.concat([bad, huber], ignore_index=True)
    best = compare_columns(compare(PUBLISHED, pool, {}), pool).set_index("metric")
    assert best.loc["mape_percent", ["tuned_model", "tuned_value", "verdict"]].tolist() == ["huber", 100.0, "better"]


def test_a_preset_that_was_not_run_is_left_out() -> None:
    only_paper = scores().query("preset == 'paper'")
    cells = compare(PUBLISHED, only_paper, {})
    assert "tuned_verdict" not in cells
    assert summary(cells, None) == ["paper preset: 5 of 8 printed cells reproduced"]


def test_where_nothing_printed_was_run_the_tables_are_empty_and_say_so() -> None:
    """A robot of one's own, or a stand-in."""
    row = {"dataset": "my_arm", "subset": "test", "model": "lr", "preset": "tuned"}
    metrics = dict.fromkeys(["rmse_mm", "mae_mm", "r2", "mape_percent"], 1.0)
    point = pd.DataFrame([row | metrics])
    cells = compare(PUBLISHED, point, {})
    columns = compare_columns(cells, point)
    assert len(cells) == len(columns) == 0
    assert "verdict" in columns
    assert summary(cells, columns) == ["nothing was run that the paper has printed"]
