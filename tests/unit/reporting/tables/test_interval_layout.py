from __future__ import annotations

import pandas as pd

from softkin.reporting.tables.interval_layout import interval_table
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE

METHODS = {"qr": "QR", "scp_mapie": "SCP (MAPIE)", "gaussian": "Own interval"}
MODELS = {"gb": "Gradient boosting", "gp": "Gaussian process", "lr": "Linear regression"}
RUNS = (("gp", "tuned"), ("gb", "paper"), ("lr", "tuned"))


def metrics(leak: bool = False) -> pd.DataFrame:
    rows = []
    for place, (model, preset) in enumerate(RUNS):
        for method, guarantee, winkler in (("scp_mapie", MARGINAL, 4.0), ("gaussian", NO_GUARANTEE, 1.0)):
            for level in (0.8, 0.9):
                for subset in ("test", "extrapolation"):
                    for coordinate in ("m1_x", "mean_informative", "joint"):
                        key = {"dataset": "arm", "model": model, "preset": preset, "interval_method": method}
                        key |= {"confidence_level": level, "subset": subset, "coordinate": coordinate}
                        values = {
                            "coverage": level + 0.012,
                            "mean_width_mm": 3.0 + place,
                            "winkler_mm": winkler + place,
                        }
                        rows.append(
                            key | values | {"winkler_mm": winkler + place, "guarantee": guarantee, "leak": leak}
                        )
    return pd.DataFrame(rows)


CHOICE = pd.DataFrame(
    [
        {"dataset": "arm", "model": "gp", "preset": "tuned", "interval_method": method}
        | {"confidence_level": 0.9, "chosen": method == "scp_mapie"}
        for method in ("scp_mapie", "gaussian")
    ]
)


def table(leak: bool = False):  # type: ignore[no-untyped-def]
    return interval_table(metrics(leak), CHOICE, {"arm": "ARM_1"}, MODELS, METHODS, ["ARM, test: mind & beware."])


def test_every_method_around_the_chosen_model_and_the_papers_at_the_level_of_the_choice() -> None:
    rows = [list(row) for row in table().rows]
    assert rows == [
        ["SCP (MAPIE), chosen", "Gaussian process, tuned", MARGINAL, "91.2", "3.00", "4.00"],
        ["SCP (MAPIE)", "Gradient boosting, paper", MARGINAL, "91.2", "4.00", "5.00"],
        ["Own interval", "Gaussian process, tuned", NO_GUARANTEE, "91.2", "3.00", "1.00"],
        ["Own interval", "Gradient boosting, paper", NO_GUARANTEE, "91.2", "4.00", "2.00"],
    ]


def test_the_best_is_bold_among_those_that_promise_something() -> None:
    text = table().markdown()
    assert "| **4.00** |" in text
    assert "**1.00**" not in text
    assert "nominal coverage 90%" in text
    assert "mind & beware" in text


def test_a_leak_is_in_the_heading() -> None:
    assert "| *ARM_1* |" in table().markdown()
    assert "| *ARM_1 (LEAK)* |" in table(leak=True).markdown()


def test_latex_is_balanced_and_escaped() -> None:
    text = table(leak=True).latex()
    for environment in ("table", "tabular"):
        assert text.count(rf"\begin{{{environment}}}") == text.count(rf"\end{{{environment}}}") == 1
    for part in (r"\emph{ARM\_1 (LEAK)}", r"Coverage (\%)", r"\textbf{4.00}", r"mind \& beware", r"coverage 90\%"):
        assert part in text
    lines = [line for line in text.splitlines() if line.endswith(r"\\") and "multicolumn" not in line]
    assert {line.replace(r"\&", "").count("&") for line in lines} == {5}
    assert text.count("{") == text.count("}")
