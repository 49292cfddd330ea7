from __future__ import annotations

from pathlib import Path

import pytest

from softkin.core.errors import DataError
from tests.tools.small_run import write_small_run
from tools.run_tables import RunTables


@pytest.fixture
def tables(tmp_path: Path) -> RunTables:
    write_small_run(tmp_path)
    return RunTables(tmp_path / "tables")


def test_scores_are_those_of_the_deployed_runs_at_the_level(tables: RunTables) -> None:
    errors = tables.deployed_in_extrapolation()
    assert errors["dataset"].tolist() == ["finger", "arm"]
    assert errors["model"].tolist() == ["gp", "lr"]
    assert errors["rmse_mm"].tolist() == [2.0, 2.0]
    assert errors["shell_rank_correlation"].tolist() == [0.1, 0.9]
    joint = tables.joint_coverage()
    assert len(joint) == 2 * 6  # two robots, each method once: one level, one run, `test`
    alarms = tables.alarms()
    assert alarms["displacement_mm"].tolist() == [0.0, 5.0] * 2


def test_target_spaces_are_compared_model_by_model(tables: RunTables) -> None:
    ratios = tables.space_ratios()
    assert list(ratios) == ["finger", "arm"]
    assert ratios.to_numpy().tolist() == [[0.5, 0.5], [0.5, 0.5]]


def test_printed_digits_stay_as_printed_where_they_are_texts(tables: RunTables) -> None:
    assert tables.read("published_columns", "printed")["printed"].tolist() == ["5.40", "4.28"]
    assert tables.read("published_columns")["printed"].tolist() == [5.4, 4.28]


def test_a_missing_table_is_named(tables: RunTables) -> None:
    with pytest.raises(DataError, match="no such table") as caught:
        tables.read("nothing")
    assert caught.value.where == str(tables.folder / "nothing.csv")
