from __future__ import annotations

import itertools

import pandas as pd

from softkin.reporting.tables.interval_layout import interval_table
from softkin.reporting.tables.paper_layout import PaperTable
from softkin.reporting.titles import Titles
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE

METHODS = {"qr": "QR", "cqr": "CQR", "scp_mapie": "SCP (MAPIE)", "gaussian": "Own interval"}
MODELS = {"gb": "Gradient boosting", "gp": "Gaussian process", "lr": "Linear regression"}
RUNS = (("gp", "tuned"), ("gb", "paper"), ("lr", "tuned"))


def metrics(leak: bool = False) -> pd.DataFrame:
    rows = []
    methods = (("scp_mapie", MARGINAL, 4.0), ("gaussian", NO_GUARANTEE, 1.0))
    for (place, (model, preset)), (method, guarantee, winkler), level, subset, coordinate in itertools.product(
        enumerate(RUNS), methods, (0.8, 0.9), ("test", "extrapolation"), ("m1_x", "mean_informative", "joint")
    ):
        key: dict[str, object] = {"dataset": "arm", "model": model, "preset": preset, "interval_method": method}
        key |= {"confidence_level": level, "subset": subset, "coordinate": coordinate}
        values = {"coverage": level + 0.012, "mean_width_mm": 3.0 + place, "winkler_mm": winkler + place}
        rows.append(key | values | {"guarantee": guarantee, "leak": leak})
    return pd.DataFrame(rows)


def choice(chosen: tuple[str, str, str], deployed: tuple[str, str, str]) -> pd.DataFrame:
    rows = [
        dict(zip(("model", "preset", "interval_method"), run, strict=True))
        | {"dataset": "arm", "confidence_level": 0.9, "chosen": run == chosen, "deployed": run == deployed}
        for run in dict.fromkeys([chosen, deployed])
    ]
    return pd.DataFrame(rows)


SCP = ("gp", "tuned", "scp_mapie")


def table(leak: bool = False, chosen: tuple[str, str, str] = SCP) -> PaperTable:
    titles = Titles(MODELS, METHODS)
    return interval_table(metrics(leak), choice(chosen, SCP), {"arm": "ARM_1"}, titles, ["ARM, test: mind & beware."])


def test_every_method_around_the_chosen_model_and_the_papers_at_the_level_of_the_choice() -> None:
    rows = [list(row) for row in table().rows]
    assert rows == [
        ["SCP (MAPIE), chosen, deployed", "Gaussian process, tuned", MARGINAL, "91.2", "3.00", "4.00"],
        ["SCP (MAPIE)", "Gradient boosting, paper", MARGINAL, "91.2", "4.00", "5.00"],
        ["Own interval", "Gaussian process, tuned", NO_GUARANTEE, "91.2", "3.00", "1.00"],
        ["Own interval", "Gradient boosting, paper", NO_GUARANTEE, "91.2", "4.00", "2.00"],
    ]
    assert not any("surrounds no point model" in note for note in table().notes)


def test_chosen_and_deployed_are_both_named_where_they_differ_and_why() -> None:
    differing = table(chosen=("lr", "tuned", "scp_mapie"))
    assert [list(row)[:2] for row in differing.rows[:3]] == [
        ["SCP (MAPIE), chosen", "Linear regression, tuned"],
        ["SCP (MAPIE), deployed", "Gaussian process, tuned"],
        ["SCP (MAPIE)", "Gradient boosting, paper"],
    ]
    (reason,) = [note for note in differing.notes if "surrounds no point model" in note]
    assert reason.startswith("ARM_1: Chosen is SCP (MAPIE) (Linear regression, tuned)")


def test_the_best_is_bold_among_those_with_a_guarantee() -> None:
    text = table().markdown()
    assert "| **4.00** |" in text
    assert "**1.00**" not in text
    assert "nominal level 90 %" in text
    assert "mind & beware" in text


def test_a_leak_is_in_the_heading() -> None:
    assert "| *ARM_1* |" in table().markdown()
    assert "| *ARM_1 (LEAK)* |" in table(leak=True).markdown()


def test_latex_is_balanced_and_escaped() -> None:
    text = table(leak=True).latex()
    for environment in ("table", "tabular"):
        assert text.count(rf"\begin{{{environment}}}") == text.count(rf"\end{{{environment}}}") == 1
    for part in (r"\emph{ARM\_1 (LEAK)}", r"Coverage (\%)", r"\textbf{4.00}", r"mind \& beware", r"level 90 \%"):
        assert part in text
    lines = [line for line in text.splitlines() if line.endswith(r"\\") and "multicolumn" not in line]
    assert {line.replace(r"\&", "").count("&") for line in lines} == {5}
    assert text.count("{") == text.count("}")
