from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.reporting.tables.published_intervals import compare_intervals, read_published_intervals, table_6
from softkin.reporting.titles import Titles
from tests.conftest import HOUSE

PUBLISHED = read_published_intervals(HOUSE / "resources" / "published" / "interval_metrics.csv")
METHODS = {"qr": "QR", "cqr": "CQR", "scp_mapie": "SCP (M)", "scp_crepes": "SCP (C)"}
TITLES = Titles({}, METHODS)


def metrics() -> pd.DataFrame:
    rows = []
    for method in METHODS:
        for coordinate, coverage, winkler in (
            ("m1_x", 0.95, 9.0),
            ("m1_z", 0.83, 2.85),
            ("mean_informative", 0.85, 6.9),
        ):
            for subset in ("test", "extrapolation"):
                key = {"dataset": "finger", "subset": subset, "model": "gb", "preset": "paper"}
                values = {"confidence_level": 0.9, "coverage": coverage, "winkler_mm": winkler}
                rows.append(key | {"interval_method": method, "coordinate": coordinate} | values)
    return pd.DataFrame(rows)


def point(mae: float) -> pd.DataFrame:
    row = {"dataset": "finger", "subset": "test", "model": "gb", "preset": "paper", "mae_informative_mm": mae}
    return pd.DataFrame([row])


def test_all_24_printed_cells_are_here_with_the_digits_as_printed() -> None:
    assert PUBLISHED.shape == (12, 4)
    for text in [*PUBLISHED["coverage"], *PUBLISHED["winkler_mm"]]:
        assert len(text.split(".")[1]) == 2, text


def test_each_cell_faces_our_average_and_the_nearest_coordinate() -> None:
    cells = compare_intervals(PUBLISHED, metrics(), point(1.0)).set_index(["interval_method", "metric"])
    assert len(cells) == 8
    crepes = cells.loc[("scp_crepes", "winkler_mm")]
    assert (crepes["printed"], crepes["honest_value"], crepes["honest_verdict"]) == ("2.84", 6.9, "higher")
    assert (crepes["nearest_coordinate"], crepes["nearest_value"], crepes["nearest_verdict"]) == (
        "m1_z",
        2.85,
        "reproduced",
    )
    assert cells.loc[("scp_crepes", "coverage"), "nearest_verdict"] == "reproduced"
    assert cells.loc[("cqr", "coverage"), "honest_verdict"] == "lower"


def test_the_freedom_of_the_search_is_counted() -> None:
    cells = compare_intervals(PUBLISHED, metrics(), point(1.0)).set_index(["interval_method", "metric"])
    assert set(cells["nearest_of"]) == {2}  # two coordinates of one run, method and level
    endless = metrics().assign(winkler_mm=lambda rows: rows["winkler_mm"].where(rows["coordinate"] != "m1_x", np.inf))
    assert set(compare_intervals(PUBLISHED, endless, point(1.0))["nearest_of"]) == {1}


@pytest.mark.parametrize(
    ("mae", "says"), [(1.25, "which the printed score keeps"), (1.6, "so the printed score is no average")]
)
def test_a_printed_score_below_twice_the_mae_cannot_be_an_average(mae: float, says: str) -> None:
    cells = compare_intervals(PUBLISHED, metrics(), point(mae)).set_index(["interval_method", "metric"])
    assert says in cells.loc[("scp_mapie", "winkler_mm"), "explanation"]
    assert "2 MAE" not in cells.loc[("qr", "winkler_mm"), "explanation"]


def test_table_6_is_laid_out_as_in_the_paper() -> None:
    text = table_6(compare_intervals(PUBLISHED, metrics(), point(1.0)), {"finger": "FINGER"}, TITLES).markdown()
    assert "| Metric | QR printed | QR ours | CQR printed" in text
    assert "| Coverage | 0.78 | 0.850 | 0.90 | 0.850 | 0.99 | 0.850 | 0.83 | 0.850 |" in text


def test_a_printed_column_may_have_been_another_method_of_its_package() -> None:
    """FINGER's MAPIE column, 0.99 and 2.97 mm, looks like CV+."""
    table = metrics()
    plus = table[table["interval_method"] == "scp_mapie"].assign(interval_method="cv_plus", confidence_level=0.95)
    plus.loc[plus["coordinate"] == "m1_z", ["coverage", "winkler_mm"]] = [0.99, 2.96]
    cells = compare_intervals(PUBLISHED, pd.concat([table, plus], ignore_index=True), point(1.0)).set_index(
        ["interval_method", "metric"]
    )
    cell = cells.loc[("scp_mapie", "winkler_mm")]
    assert (cell["nearest_interval_method"], cell["nearest_confidence_level"]) == ("cv_plus", 0.95)
    assert cell["nearest_verdict"] == "reproduced"
    assert "cv_plus at 95%" in cell["explanation"]
    assert cells.loc[("scp_crepes", "winkler_mm"), "nearest_interval_method"] == "scp_crepes"
