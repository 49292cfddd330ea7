from __future__ import annotations

from typing import Any

from softkin.reporting.page.grid import number_columns
from softkin.reporting.page.marks import Mark, Marks, kinds, merged

LEAK = {"severity": "leak", "subsets": ["test", "validation"], "sentence": "Copies.", "consequence": "No test."}
WARNING = {"severity": "warning", "subsets": ["test"], "sentence": "Few rows.", "consequence": "Mind."}


def marks(*findings: dict[str, Any], notes: dict[str, str] | None = None, **description: Any) -> Marks:
    return Marks(
        {"arm": {"notes": notes or {}}}, {"arm": {"is_cut": False} | description}, {"arm": {"findings": findings}}
    )


def test_a_leak_marks_its_subsets_and_a_warning_none() -> None:
    of = marks(LEAK, WARNING)
    assert of.of("arm", "test") == (Mark("leak", "arm, test: Copies. No test."),)
    assert of.of("arm", "train") == of.of("arm", "extrapolation") == ()


def test_an_interval_is_marked_where_its_calibration_set_leaks() -> None:
    only_validation = marks(LEAK | {"subsets": ["validation"]})
    assert only_validation.of("arm", "test") == ()
    assert kinds(only_validation.of_interval("arm", "test")) == ["leak"]


def test_a_note_stands_with_the_leak_of_its_subset_or_is_a_caution() -> None:
    notes = {"test": "Mind the gap."}
    (leak,) = marks(LEAK, notes=notes).of("arm", "test")
    assert leak == Mark("leak", "arm, test: Copies. No test. Mind the gap.")
    (caution,) = marks(notes=notes).of("arm", "test")
    assert caution == Mark("caution", "arm, test: Mind the gap.")


def test_rows_left_out_and_stand_ins_mark_every_subset_once() -> None:
    of = marks(is_cut=True, origin="stand-in")
    assert kinds(of.of("arm", "train")) == ["rows left out", "stand-in"]
    assert kinds(of.of_dataset("arm")) == ["rows left out", "stand-in"]


def test_merging_keeps_each_mark_once_in_order() -> None:
    one, two = Mark("leak", "x"), Mark("leak", "y")
    assert merged([[one], [two, one]]) == (one, two)
    assert kinds([one, two]) == ["leak"]


def test_neighbours_in_time_make_a_subset_optimistic() -> None:
    finding = WARNING | {"code": "neighbours_in_time", "sentence": "optimistic: beside train.", "consequence": "See."}
    assert marks(finding).of("arm", "test") == (Mark("optimistic", "arm, test: optimistic: beside train. See."),)
    assert marks(finding).of("arm", "train") == ()


def test_a_unit_that_is_not_mm_is_a_mark_and_heads_columns() -> None:
    about = {"is_cut": False, "origin": "own"}
    sources: dict[str, dict[str, Any]] = {"arm": {}, "cam": {}}
    cards: dict[str, dict[str, Any]] = {name: {"findings": []} for name in sources}
    of = Marks(sources, {"arm": about, "cam": about | {"unit": "px"}}, cards)
    assert (of.unit, of.units) == ("mm or px", {"arm": "mm", "cam": "px"})
    assert kinds(of.of("cam", "test")) == ["in px"]
    assert of.of("arm", "test") == ()
    assert number_columns("Width ({unit})", "R2", unit=of.unit)[0].title == "Width (mm or px)"


def test_models_that_are_fitted_on_fewer_rows_than_train_has_are_named() -> None:
    sources: dict[str, dict[str, Any]] = {"long": {}, "short": {}}
    about = {name: {"is_cut": False, "rows": {"train": rows}} for name, rows in (("long", 26136), ("short", 4000))}
    bounds = {"gp": 4000, "rf": 10000, "xgb": 30000}
    of = Marks(sources, about, {name: {"findings": []} for name in sources}, dict.fromkeys(sources, bounds))
    text = "of 26136 rows of train, models are fitted on some, drawn at random (max_fit_rows): gp (4000), rf (10000)"
    assert of.of("long", "test") == of.of_dataset("long") == (Mark("fitted on fewer rows", f"long: {text}."),)
    assert of.of_dataset("short") == ()


def test_a_subset_of_which_rows_were_drawn_says_of_how_many() -> None:
    rows = {"train": 26136, "test": 4000, "extrapolation": 4000}
    about = {"long": {"is_cut": False, "rows": rows, "drawn_from": {"extrapolation": 17820}}}
    of = Marks({"long": {}}, about, {"long": {"findings": []}})
    text = "long: 4000 of 17820 rows of extrapolation are kept, drawn at random (max_scored_rows)."
    assert of.of("long", "extrapolation") == (Mark("some of its rows", text),)
    assert of.of("long", "test") == ()
