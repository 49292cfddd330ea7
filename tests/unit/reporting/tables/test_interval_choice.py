from __future__ import annotations

from typing import Any

import pandas as pd
import pytest

from softkin.models.spec import PAPERS_RUN
from softkin.reporting.tables.interval_choice import (
    PAPERS_METHOD,
    chosen_intervals,
    deployed_intervals,
    interval_choice,
    why_another_is_deployed,
)
from softkin.reporting.titles import Titles

TITLES = Titles(
    {"gb": "Gradient boosting", "gp": "Gaussian process"}, {"cqr": "CQR", "scp_mapie": "SCP", "scp_spread": "By spread"}
)


def candidates(*deployed: str) -> pd.DataFrame:
    """Best first: one on quantile regressors, two around the deployed model."""
    rows = [("gb", "cqr"), ("gp", "scp_spread"), ("gp", "scp_mapie")]
    return pd.DataFrame(
        {"model": model, "preset": "tuned", "interval_method": method, "confidence_level": 0.9, "cv_winkler_mm": place}
        | {"chosen": place == 0, "deployed": method in deployed, "outside": "auto" if method in deployed else method}
        for place, (model, method) in enumerate(rows)
    )


def metrics() -> pd.DataFrame:
    """Scores of every candidate, of `auto` and of the paper's recipe; other coordinates and levels are wrong."""
    runs = [
        ("gb", "tuned", "cqr"),
        ("gp", "tuned", "scp_spread"),
        ("gp", "tuned", "scp_mapie"),
        ("gp", "tuned", "auto"),
    ]
    rows = []
    for place, (model, preset, method) in enumerate([*runs, (*PAPERS_RUN, PAPERS_METHOD)], start=1):
        for subset, factor in (("test", 1.0), ("extrapolation", 10.0)):
            key: dict[str, Any] = {
                "dataset": "arm",
                "subset": subset,
                "model": model,
                "preset": preset,
                "interval_method": method,
            }
            scores = {"coverage": place / 10, "mean_width_mm": factor * place, "winkler_mm": 2 * factor * place}
            scores |= {"winkler_without_gross_mm": 2 * factor * (1 + place)}
            key["n_commands"] = 12 if subset == "extrapolation" else 99
            for coordinate, level in (("m1_x", 0.9), ("mean_informative", 0.8), ("mean_informative", 0.9)):
                is_shown = coordinate == "mean_informative" and level == 0.9
                row = key | {"coordinate": coordinate, "confidence_level": level}
                rows.append(row | (scores if is_shown else dict.fromkeys(scores, -1.0)))
    return pd.DataFrame(rows)


def test_candidates_get_their_scores_on_test_and_by_the_method_that_takes_over_on_extrapolation() -> None:
    table = interval_choice({"arm": candidates("scp_spread")}, metrics())
    assert next(iter(table)) == "dataset"
    assert table["test_winkler_mm"].tolist() == [2.0, 4.0, 6.0]
    assert table["test_coverage"].tolist() == [0.1, 0.2, 0.3]
    assert table["extrapolation_mean_width_mm"].tolist() == [10.0, 40.0, 30.0]  # `auto` in place of the second


def test_the_winkler_score_is_compared_with_the_papers_recipe() -> None:
    table = interval_choice({"arm": candidates()}, metrics())
    assert table["winkler_ratio_to_paper"].tolist() == pytest.approx([0.2, 0.4, 0.6])
    assert table["winkler_ratio_to_paper_without_gross"].tolist() == pytest.approx([4 / 12, 6 / 12, 8 / 12])
    without = metrics()
    without = without[without["preset"] != PAPERS_RUN.preset]
    assert interval_choice({"arm": candidates()}, without)["winkler_ratio_to_paper"].isna().all()


def test_few_distinct_commands_in_extrapolation_are_not_assessable() -> None:
    table = interval_choice({"arm": candidates()}, metrics())
    assert set(table["extrapolation_commands"]) == {12}
    assert not table["extrapolation_assessable"].any()
    many = interval_choice({"arm": candidates()}, metrics().assign(n_commands=29))
    assert many["extrapolation_assessable"].all()


def choice() -> pd.DataFrame:
    """`arm` has another method deployed than chosen, `finger` the same, `rod` none."""
    of_finger = candidates("scp_spread").iloc[1:].assign(chosen=[True, False])
    frames = {"arm": candidates("scp_spread"), "finger": of_finger, "rod": candidates()}
    return pd.concat([frame.assign(dataset=name) for name, frame in frames.items()], ignore_index=True)


def test_chosen_and_deployed_by_dataset() -> None:
    assert chosen_intervals(choice())["interval_method"].to_dict() == {
        "arm": "cqr",
        "finger": "scp_spread",
        "rod": "cqr",
    }
    deployed = deployed_intervals(choice())
    assert deployed["interval_method"].to_dict() == {"arm": "scp_spread", "finger": "scp_spread", "rod": "cqr"}
    assert deployed["deployed"].tolist() == [True, True, False]


def test_where_they_differ_a_sentence_says_why() -> None:
    sentences = why_another_is_deployed(choice(), TITLES)
    assert set(sentences) == {"arm", "rod"}
    assert sentences["arm"] == (
        "Chosen is CQR (Gradient boosting, tuned), of the lowest typical Winkler score, cross-validated; it has "
        "quantile regressors of its own and surrounds no point model, so deployed is By spread (Gaussian process, "
        "tuned), the best around the deployed model."
    )
    assert sentences["rod"].endswith("so none is deployed.")
