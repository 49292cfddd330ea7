from __future__ import annotations

import pandas as pd
import pytest

from softkin.reporting.page.headline import RobotCard, robot_cards
from tests.unit.reporting.page.frames import NO_MARKS, ROBOTS, TITLES, frames

DESCRIPTIONS = {name: {"title": name.upper()} for name in ROBOTS}


def cards(**changed: pd.DataFrame | None) -> dict[str, RobotCard]:
    tables = {name: frame for name, frame in (frames() | changed).items() if frame is not None}
    return {card.dataset: card for card in robot_cards(tables, DESCRIPTIONS, TITLES, NO_MARKS)}


def errors(mean: float, p95: float) -> pd.DataFrame:
    """The deployed run's errors on test; ten times as large on extrapolation."""
    table = frames()["point_metrics"]
    factor = table["subset"].map({"extrapolation": 10.0}).fillna(1.0)
    return table.assign(euclidean_mean_mm=mean * factor, euclidean_p95_mm=p95 * factor)


def test_a_card_says_the_deployed_models_errors() -> None:
    card = cards(point_metrics=errors(0.5, 1.25))["arm"]
    assert card.title == "ARM"
    assert card.errors
    assert (card.errors.model, card.errors.mean, card.errors.remark) == ("Gaussian process, tuned", "0.500 mm", "")
    assert [mark.kind for mark in card.errors.marks] == ["deployed"]
    assert card.errors.facts == [
        ("95 % of test cases below", "1.25 mm"),
        ("mean error, extrapolation", "5.00 mm"),
        ("runner-up", "Linear regression, 1.25 times the score"),
    ]


def test_a_mean_above_the_95th_percentile_is_remarked_upon() -> None:
    card = cards(point_metrics=errors(2.0, 1.25))["arm"]
    assert card.errors
    assert "gross errors set the mean" in card.errors.remark


@pytest.mark.parametrize("runner_up", ["", float("nan")])
def test_a_pool_of_one_model_has_no_runner_up(runner_up: object) -> None:
    card = cards(selection=frames()["selection"].assign(runner_up=runner_up))["arm"]
    assert card.errors
    assert "runner-up" not in dict(card.errors.facts)


def test_without_a_search_no_model_is_chosen() -> None:
    card = cards(selection=None)["arm"]
    assert card.errors is None
    assert card.interval.method == "System around Gaussian process, tuned"


def test_few_distinct_commands_in_extrapolation_are_not_assessable() -> None:
    table = frames()["interval_choice"].assign(extrapolation_commands=12, extrapolation_assessable=False)
    name = "coverage, extrapolation (no guarantee)"
    assert dict(cards(interval_choice=table)["arm"].interval.facts)[name] == "not assessable: 12 distinct commands"
    assert dict(cards()["arm"].interval.facts)[name] == "80.0 %"


def test_the_interval_is_the_deployed_one() -> None:
    interval = cards()["arm"].interval
    assert interval.method == "System around Gaussian process, tuned"
    assert [mark.kind for mark in interval.marks] == ["chosen", "deployed"]
    assert interval.reason == ""
    assert interval.facts == [
        ("mean width of a 90 % interval", "below a nanometre"),
        ("coverage, test", "90.0 %"),
        ("coordinates covered as guaranteed", "1 of 2"),
        ("coverage, extrapolation (no guarantee)", "80.0 %"),
        ("mean width, extrapolation", "0.500 mm"),
    ]


def test_where_another_interval_is_chosen_the_card_says_which_and_why() -> None:
    interval = cards()["finger"].interval
    assert [mark.kind for mark in interval.marks] == ["deployed"]
    assert interval.reason.startswith("Chosen is CQR (Gradient boosting, tuned)")
    assert "quantile regressors of its own" in interval.reason


def test_joint_intervals_stand_beside_how_often_single_ones_hold_a_whole_pose() -> None:
    metrics = frames()["interval_metrics"]
    joint = metrics[(metrics["interval_method"] == "joint_box") & (metrics["dataset"] == "arm")]
    joint = joint.assign(interval_method="joint_intervals", shape="box", coverage=0.9, size_mm=2.0)
    facts = dict(cards(interval_metrics=pd.concat([metrics, joint]))["arm"].interval.facts)
    assert facts["whole poses within all intervals, test"] == "70.0 %"
    assert facts["whole poses within joint intervals (box), test"] == "90.0 %"
    assert facts["side of a cube of a joint interval's volume"] == "2.00 mm"
    assert "whole poses within all intervals, test" not in dict(cards()["finger"].interval.facts)


def test_where_intervals_hold_least_is_told() -> None:
    rows = [
        {"dataset": "arm", "by": by, "group": group, "n_rows": n_rows, "coverage": coverage}
        for by, group, n_rows, coverage in (
            *(("failure", "may fail", 5, 1.0), ("failure", "others", 390, 0.9)),
            *(("small_region", "u1 0.1 to 0.2", 21, 0.5), ("marker", "m1", 395, 0.91)),
        )
    ]
    told = cards(conditional_coverage=pd.DataFrame(rows))
    facts = dict(told["arm"].interval.facts)
    assert facts["coverage of 5 rows that may fail, test"] == "100.0 %"
    assert facts["coverage of 390 other rows, test"] == "90.0 %"
    assert facts["coverage of 21 rows at u1 0.1 to 0.2, the worst on validation"] == "50.0 %"
    assert told["finger"].interval.facts == cards()["finger"].interval.facts
