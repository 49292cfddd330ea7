from __future__ import annotations

import pandas as pd

from softkin.reporting.tables.headline import headline


def scores(mean: float, p95: float) -> pd.DataFrame:
    return pd.DataFrame(
        [
            {"dataset": "arm", "model": "gp", "preset": "tuned", "subset": subset}
            | {"euclidean_mean_mm": mean * factor, "euclidean_p95_mm": p95 * factor}
            for subset, factor in (("test", 1.0), ("extrapolation", 3.0))
        ]
    )


SURE = pd.DataFrame(
    [
        {"dataset": "arm", "model": "gp", "preset": "tuned", "interval_method": method, "confidence_level": 0.9}
        | {
            "test_mean_width_mm": width,
            "test_coverage": 0.912,
            "extrapolation_coverage": 0.95,
            "chosen": method == "cqr",
            "deployed": method == "scp_spread",
        }
        for method, width in (("cqr", 7.0), ("scp_spread", 2.5))
    ]
)
CHOSEN = pd.DataFrame([{"dataset": "arm", "model": "gp", "preset": "tuned", "objective": "both"}])


def test_the_chosen_model_and_its_errors() -> None:
    text = headline(CHOSEN, scores(0.5, 1.25), SURE, ["tuned preset: 3 of 4"])
    assert "arm gp tuned 0.500 1.25 1.50" in " ".join(text.split())
    assert "tuned preset: 3 of 4" in text
    assert "chosen for commands like those of train and beyond, on `train` alone" in text
    assert "gross misses" not in text
    assert max(map(len, text.splitlines())) <= 90


def test_a_mean_set_by_a_few_rows_is_remarked_upon() -> None:
    assert "arm: a few gross misses set the mean" in headline(CHOSEN, scores(2.0, 1.25), SURE, [])


def test_without_tuning_there_is_no_choice_to_show() -> None:
    text = headline(None, scores(1.0, 2.0), SURE, [])
    assert "The model is chosen" not in text


def test_the_interval_of_the_calibrated_model_and_what_it_covers() -> None:
    """Not the chosen one, which a learner of quantiles gives."""
    text = headline(CHOSEN, scores(0.5, 1.25), SURE, [])
    assert "arm gp tuned scp_spread 2.50 91.2% 95.0%" in " ".join(text.split())
    assert "cqr" not in text
    text = headline(CHOSEN, scores(0.5, 1.25), SURE.assign(deployed=False), [])
    assert "arm gp tuned cqr 7.00 91.2% 95.0%" in " ".join(text.split())
