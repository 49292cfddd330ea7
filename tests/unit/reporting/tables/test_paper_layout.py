from __future__ import annotations

import pandas as pd
import pytest

from softkin.models import MODELS
from softkin.reporting.tables.paper_layout import comparison_table, format_number, subset_table
from softkin.reporting.tables.published import compare, read_published
from tests.conftest import HOUSE

NAMES = {name: spec.title for name, spec in MODELS.items()}


@pytest.mark.parametrize(
    ("value", "text"), [(2.8912, "2.89"), (114.73, "115"), (0.0004123, "4.12e-04"), (-6.678, "-6.68"), (0.0, "0.0")]
)
def test_three_digits(value: float, text: str) -> None:
    assert format_number(value) == text


def point() -> pd.DataFrame:
    rows = []
    for subset in ("test", "extrapolation"):
        for model, factor in (("lr", 1.0), ("gp", 0.5)):
            for preset in ("paper", "tuned"):
                values = {"rmse_mm": 2 * factor, "mae_mm": factor, "r2": 1 - factor / 3, "mape_percent": 30 * factor}
                rows.append({"dataset": "finger", "subset": subset, "model": model, "preset": preset} | values)
    return pd.DataFrame(rows)


def table_5(number: int | None = 5):  # type: ignore[no-untyped-def]
    cells = compare(read_published(HOUSE / "config" / "published" / "point_metrics.csv"), point(), {})
    return comparison_table(number, "finger", "FINGER", point(), cells, NAMES, ["Testing: mind the gap & more."])


def test_printed_paper_and_tuned_stand_side_by_side_best_in_bold() -> None:
    text = table_5().markdown()
    lines = text.splitlines()
    assert lines[0] == "### Table 5: comparison on FINGER"
    assert lines[2].startswith("| Method | RMSE (mm) printed | RMSE (mm) paper | RMSE (mm) tuned | MAE (mm) printed")
    gp = next(line for line in lines if line.startswith("| Gaussian process"))
    assert gp.startswith("| Gaussian process | **4.32** | **1.00** | **1.00** | **3.64** |")
    lr = next(line for line in lines if line.startswith("| Linear regression"))
    assert lr.startswith("| Linear regression | 4.33 | 2.00 | 2.00 | **3.64** |")  # a tie as printed
    assert next(line for line in lines if line.startswith("| *")).startswith("| *Testing*")
    assert "mind the gap" in text
    assert len({line.count("|") for line in lines if line.startswith("|")}) == 1


def test_a_dataset_outside_the_paper_has_no_printed_columns() -> None:
    text = table_5(None).markdown()
    assert "printed" not in text
    assert "not in the paper" in text


def test_latex_is_balanced_and_escaped() -> None:
    text = table_5().latex()
    for environment in ("table", "tabular"):
        assert text.count(rf"\begin{{{environment}}}") == text.count(rf"\end{{{environment}}}") == 1
    for command in (r"\toprule", r"\midrule", r"\bottomrule", r"\textbf{4.32}", r"MAPE (\%)", "$R^2$", r"gap \& more"):
        assert command in text
    rows = [line for line in text.splitlines() if line.endswith(r"\\") and "multicolumn" not in line]
    assert {line.replace(r"\&", "").count("&") for line in rows} == {12}


def test_table_2_shows_our_sizes_beside_the_printed_ones() -> None:
    about = {"dataset": "finger", "title": "FINGER", "n_commands": 2, "n_markers": 1, "rows": {"train": 704, "test": 9}}
    published = pd.read_csv(HOUSE / "config" / "published" / "subsets.csv")
    text = subset_table([about], published).markdown()
    assert "| train | 704 | 704 | 2 | 3 |" in text
    assert "| test | 9 | 89 | 2 | 3 |" in text
