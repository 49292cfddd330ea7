from __future__ import annotations

import pandas as pd

from softkin.models import MODELS
from softkin.reporting.tables.paper_layout import PaperTable, comparison_table, presets_of, subset_table
from softkin.reporting.tables.published import compare, read_published
from tests.conftest import HOUSE

NAMES = {name: spec.title for name, spec in MODELS.items()}


def point() -> pd.DataFrame:
    rows = []
    for subset in ("test", "extrapolation"):
        for model, factor in (("lr", 1.0), ("gp", 0.5)):
            for preset in ("paper", "tuned"):
                values = {"rmse_mm": 2 * factor, "mae_mm": factor, "r2": 1 - factor / 3, "mape_percent": 30 * factor}
                rows.append({"dataset": "finger", "subset": subset, "model": model, "preset": preset} | values)
    return pd.DataFrame(rows)


def table_5(number: int | None = 5) -> PaperTable:
    cells = compare(read_published(HOUSE / "resources" / "published" / "point_metrics.csv"), point(), {})
    notes = ["Testing: mind the gap & more."]
    return comparison_table(number, "finger", "FINGER", point=point(), cells=cells, model_titles=NAMES, notes=notes)


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


def test_a_dataset_that_the_paper_does_not_have_has_no_printed_columns() -> None:
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
    description = {
        "dataset": "finger",
        "title": "FINGER",
        "n_commands": 2,
        "n_markers": 1,
        "rows": {"train": 704, "test": 9},
    }
    published = pd.read_csv(HOUSE / "resources" / "published" / "subsets.csv")
    text = subset_table([description], published).markdown()
    assert "| train | 704 | 704 | 2 | 3 |" in text
    assert "| test | 9 | 89 | 2 | 3 |" in text


def test_a_model_that_the_paper_does_not_have_has_a_dash_for_its_printed_cells() -> None:
    extra = pd.concat([point(), point().query("model == 'gp'").assign(model="huber", rmse_mm=4.12e-4)])
    cells = compare(read_published(HOUSE / "resources" / "published" / "point_metrics.csv"), extra, {})
    table = comparison_table(5, "finger", "FINGER", point=extra, cells=cells, model_titles=NAMES, notes=[])
    assert table.rows[2][:3] == [NAMES["huber"], "–", "0.000412"]
    assert (2, 2) in table.bold  # the lowest error of its column
    assert (2, 1) not in table.bold


def test_presets_come_in_their_order() -> None:
    assert presets_of(point()) == ["paper", "tuned"]


def test_what_latex_would_take_for_its_own_is_escaped() -> None:
    table = PaperTable("R2 & more", ["Method", "50 %"], [["a_b", "<0.000000001"]], {(0, 1)}, [("", 1)], ["#1"])
    text = table.latex()
    for part in (r"\caption{$R^2$ \& more}", r"50 \%", r"a\_b", r"\textbf{$<$0.000000001}", r"\#1"):
        assert part in text
    assert "emph" not in text  # a group without a heading
