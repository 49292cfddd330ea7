from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pytest

from softkin.tracking.model_card import model_card
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.promise import Promise, promised
from tests.unit.tracking.robots import DESCRIPTION, LEAK, interval_metrics, point_metrics, robot, with_shells
from tests.unit.uncertainty.test_failures import found


def card(
    model: CalibratedModel | None = None,
    caution: str | None = None,
    n_commands: int = 40,
    level: float = 0.9,
    **changed: Any,
) -> str:
    description = DESCRIPTION | {"findings": [LEAK]} | changed
    metrics = interval_metrics().assign(n_commands=n_commands)
    metrics = metrics[metrics["confidence_level"] == 0.9].set_index("subset")
    means, joint = (metrics[metrics["coordinate"] == name] for name in ("mean_informative", "joint"))
    return model_card(
        model or robot(),
        registered="softkin-finger",
        description=description,
        scores=point_metrics().set_index("subset"),
        intervals=means.assign(joint_coverage=joint["coverage"], joint_size_mm=joint["size_mm"]),
        level=level,
        caution=caution,
    )


def test_it_says_errors_guarantee_data_and_use() -> None:
    text = card()
    assert text.startswith("# FINGER\n\nGaussian process (tuned preset): 2 commands to the position of 1 marker")
    for part in (
        "| rows | mean marker error, mm | 95 % below, mm | RMSE, mm | 90 % intervals cover | mean width, mm | "
        "joint intervals hold |",
        "| test | 0.250 | 0.500 | 0.125 | 92.0 % | 2.00 | 91.0 % |",
        "| extrapolation | 0.250 | 0.500 | 0.125 | 92.0 % | 2.00 | 91.0 % |",
        f"A joint interval at 90 % ({robot().joint.shape.kind}) holds the whole pose",
        "in at least 90 % of cases",
        "the 60 rows of `validation`",
        "60 train, 60 validation, 60 test, 60 extrapolation rows; origin: published",
        "**leak**: Nine rows of test stand in train. It is training error.",
        'load_model("models:/softkin-finger@champion")',
        'pandas.DataFrame({"u1": [0.0], "u2": [0.0]})',
        '"confidence_level": 0.9',
    ):
        assert part in text


def test_few_distinct_commands_in_extrapolation_are_not_assessable() -> None:
    text = card(n_commands=28)
    assert "| extrapolation | 0.250 | 0.500 | 0.125 | not assessable | 2.00 |" in text
    assert "| test | 0.250 | 0.500 | 0.125 | 92.0 % | 2.00 |" in text


def test_simulated_data_come_with_a_warning_before_anything_else() -> None:
    assert card(origin="stand-in").splitlines()[2].startswith("**STAND-IN")
    assert "STAND-IN" not in card()


def test_a_caution_of_the_configuration_stands_before_the_numbers() -> None:
    text = card(caution="Few trials.")
    assert text.splitlines()[2] == "**CAUTION**: Few trials."
    assert "CAUTION" not in card()


def test_rows_that_were_left_out_are_named() -> None:
    assert "Rows were left out" in card(is_cut=True)
    assert "Rows were left out" not in card()


def test_a_sound_dataset_says_so() -> None:
    assert "The audit has no finding." in card(findings=[])
    assert "The audit has no finding." not in card()


@pytest.mark.parametrize(("has_shells", "says"), [(True, True), (False, False)])
def test_intervals_made_for_extrapolation_are_explained_and_not_guaranteed(has_shells: bool, says: bool) -> None:
    text = card(with_shells(robot()) if has_shells else robot())
    assert ("outer shells" in text) == says
    assert "nothing is guaranteed" in text


def test_a_method_without_a_guarantee_has_none() -> None:
    text = card(robot(method="gaussian"))
    assert "Intervals by this method have no guarantee." in text
    assert "An interval at" not in text
    assert text.count("in at least") == 1  # joint intervals keep theirs


def test_a_guarantee_by_block_is_that_of_the_level_that_is_shown() -> None:
    """Twelve blocks promise 90 % and not 95 %."""
    plain, promise = robot(), Promise(12, 5)
    model = replace(plain, method=promised(plain.method, promise), joint=replace(plain.joint, promise=promise))
    assert "in at least 90 % of cases in a new block" in card(model)
    text = card(model, level=0.95)
    assert "have no guarantee at 95 %: too few blocks of rows are held out." in text
    assert "at least 95 %" not in text


def test_failures_that_commands_foretell_are_told() -> None:
    text = card(replace(robot(), failures=found()))
    assert f"{found().n_failed} of 900 rows of `train` are gross errors that commands foretell" in text
    assert "Where that is above 10 %" in text
    assert "## Failures" not in card()


def test_lengths_are_in_the_robots_own_unit() -> None:
    text = card(unit="px")
    assert "| rows | mean marker error, px | 95 % below, px | RMSE, px | 90 % intervals cover |" in text
    assert "# in px: y_pred_m1_x" in text
    assert not re.search(r"\bmm\b", text)
