from __future__ import annotations

from softkin.reporting.page.choices import CHOSEN, DEPLOYED, marks_of_candidate, read_choices
from tests.unit.reporting.page.frames import frames

GP = ("gp", "tuned")


def test_the_deployed_run_is_that_of_the_selection() -> None:
    tables = frames()
    tables["selection"] = tables["selection"].assign(deployed=[True, False])
    choices = read_choices(tables)
    assert choices.of_run("arm", *GP) == (DEPLOYED,)
    assert choices.of_run("finger", *GP) == choices.of_run("arm", "gp", "paper") == ()


def test_without_a_search_it_is_that_of_the_deployed_interval() -> None:
    tables = frames()
    del tables["selection"]
    choices = read_choices(tables)
    assert choices.runs == {("arm", *GP), ("finger", *GP)}


def test_one_interval_may_be_both_chosen_and_deployed() -> None:
    choices = read_choices(frames())
    assert choices.of_interval("arm", "test", *GP, "cps") == (CHOSEN, DEPLOYED)
    assert choices.of_interval("finger", "test", *GP, "cps") == (DEPLOYED,)
    assert choices.of_interval("finger", "test", "gb", "tuned", "cqr") == (CHOSEN,)
    assert choices.of_interval("arm", "test", *GP, "scp_mapie") == ()


def test_in_extrapolation_the_method_that_takes_over_is_marked() -> None:
    choices = read_choices(frames())
    assert choices.of_interval("arm", "extrapolation", *GP, "auto") == (CHOSEN, DEPLOYED)
    assert choices.of_interval("arm", "extrapolation", *GP, "cps") == ()
    assert choices.of_interval("finger", "extrapolation", "gb", "tuned", "cqr") == (CHOSEN,)


def test_marks_of_a_candidate() -> None:
    assert marks_of_candidate(True, False) == (CHOSEN,)
    assert marks_of_candidate(False, False) == ()
