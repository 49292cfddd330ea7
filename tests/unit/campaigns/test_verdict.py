from __future__ import annotations

import json

import pytest

from softkin.campaigns.changes import Changes
from softkin.campaigns.comparison import BETTER, COVERAGE, ERROR, SAME, WORSE, Comparison
from softkin.campaigns.verdict import BUSY, EXIT_CODES, HEADINGS, Verdict, judge


def one(outcome: str, metric: str = ERROR) -> Comparison:
    return Comparison("finger", "test", metric, 1.0, 1.25, 80, True, 0.001, 1.0, outcome)


PERSON = Changes([], ["finger: the origin is stand-in, before published."])
NONE = Changes()


@pytest.mark.parametrize(
    ("comparisons", "changes", "jobs", "outcome", "code"),
    [
        ([one(SAME)], NONE, 0, "unchanged", 0),
        ([one(SAME)], NONE, 5, "same", 0),
        ([one(BETTER), one(SAME)], NONE, 5, "better", 0),
        ([one(BETTER), one(WORSE)], NONE, 5, "worse", 3),
        ([one(WORSE)], PERSON, 5, "data_changed", 4),
        ([one(SAME)], Changes(["numpy is 2.5, before 2.4."]), 5, "same", 0),
    ],
)
def test_a_night_ends_in_one_of_known_ways(
    comparisons: list[Comparison], changes: Changes, jobs: int, outcome: str, code: int
) -> None:
    verdict = judge(comparisons, changes, jobs_run=jobs, facts={})
    assert (verdict.outcome, verdict.exit_code) == (outcome, code)
    assert HEADINGS[outcome] in verdict.as_markdown()


def test_every_outcome_has_an_exit_code_and_all_but_busy_a_heading() -> None:
    assert set(HEADINGS) == set(EXIT_CODES) - {BUSY}
    assert sorted(set(EXIT_CODES.values())) == [0, 1, 3, 4, 75]


def test_the_page_says_what_is_worse_by_how_much() -> None:
    verdict = judge([one(WORSE), one(SAME, COVERAGE)], Changes(["arm is new."]), jobs_run=3, facts={"jobs_run": 3})
    page = verdict.as_markdown()
    assert "- finger, test: the mean error of a marker, mm is 1.25, before 1.00 (p = 0.001)." in page
    assert "- arm is new." in page
    assert "| jobs run | 3 |" in page
    assert "| finger | test | coverage | 100.0 % | 125.0 % | same |" in page
    assert json.loads(json.dumps(verdict.as_dict(), allow_nan=False))["comparisons"][0]["outcome"] == "worse"


def test_what_a_person_must_look_at_comes_first() -> None:
    verdict = judge([one(WORSE)], PERSON, jobs_run=3, facts={})
    assert verdict.reasons[0] == PERSON.for_a_person[0]
    assert len(verdict.reasons) == 2


def test_a_fact_that_is_not_known_says_so_and_no_sign_ends_a_cell() -> None:
    assert "| jobs reused | unknown |" in Verdict("first", facts={"jobs_reused": None}).as_markdown()
    assert "a\\|b" in Verdict("first", facts={"commit": "a|b"}).as_markdown()
