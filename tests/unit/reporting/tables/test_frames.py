from __future__ import annotations

import pandas as pd

from softkin.reporting.tables.frames import CUT
from tests.unit.reporting.tables.conftest import SOURCES, Run

ALWAYS = {
    *("point_metrics", "marker_errors", "interval_metrics", "interval_choice", "conditional_coverage", "alarm_rates"),
    *("extrapolation_intervals", "target_spaces", "published_comparison", "published_intervals"),
    *("left_out", "claims"),
}


def test_every_table_is_there_and_datasets_come_in_order(run: Run) -> None:
    frames = run.tables().frames
    assert set(frames) == ALWAYS | {"published_columns", "selection", "searched_runs"}
    for name in ("point_metrics", "interval_choice", "selection"):
        assert list(dict.fromkeys(frames[name]["dataset"])) == list(SOURCES), name


def test_where_nothing_was_searched_nothing_is_selected(run: Run) -> None:
    assert set(run.tables(searched=False).frames) == ALWAYS | {"published_columns"}


def test_without_tuned_models_no_column_is_compared(run: Run) -> None:
    for files in run.datasets.values():
        table = pd.read_csv(files.point)
        table[table["preset"] == "paper"].to_csv(files.point, index=False)
    assert set(run.tables(searched=False).frames) == ALWAYS


def test_rows_that_leak_are_marked_in_every_table_of_scores(run: Run) -> None:
    frames = run.tables().frames
    for name in ALWAYS - {"published_comparison", "published_intervals", "left_out", "claims"}:
        frame = frames[name]
        is_test = frame["subset"] == "test" if "subset" in frame else True
        assert frame["leak"].equals((frame["dataset"] == "arm") & is_test), name


def test_notes_are_those_of_the_entry_of_leaks_and_of_rows_left_out(run: Run) -> None:
    notes = run.tables().notes
    assert notes["finger", "extrapolation"] == "Far out."
    assert notes["arm", "test"] == f"LEAK: All rows stand in train. No test. {CUT}"
    assert notes["arm", "extrapolation"] == CUT
    assert set(notes) == {("finger", "extrapolation"), ("arm", "test"), ("arm", "extrapolation")}


def test_only_datasets_of_the_paper_are_compared_with_it(run: Run) -> None:
    tables = run.tables()
    assert set(tables.frames["published_comparison"]["dataset"]) == {"finger"}
    assert set(tables.frames["published_comparison"]["note"]) == {"", "Far out."}
    assert set(tables.frames["published_intervals"]["dataset"]) == {"finger"}
    assert {"finger"} <= set(tables.published_subsets["dataset"])


def test_the_selection_is_by_the_scores_on_train(run: Run) -> None:
    selection = run.tables().frames["selection"]
    assert set(selection["model"]) == {"gb"}
    assert selection.loc[selection["deployed"], "objective"].tolist() == ["both", "both"]


def test_a_score_of_a_point_model_with_a_row_left_out_has_no_method(run: Run) -> None:
    frames = run.tables().frames
    assert frames["left_out"]["interval_method"].tolist() == ["", ""]
    assert "would take" in frames["claims"]["numbers"].iloc[0]  # two models are not the paper's eight
