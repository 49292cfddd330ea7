from __future__ import annotations

import pandas as pd

from softkin.core.samples import SUBSETS
from softkin.reporting.tables.leaks import marked

LEAKS = {"copied": {"validation", "test"}, "calibrated_only": {"validation"}, "clean": set()}


def frame() -> pd.DataFrame:
    return pd.DataFrame([{"dataset": dataset, "subset": subset} for dataset in LEAKS for subset in SUBSETS])


def leaking(table: pd.DataFrame) -> set[tuple[str, str]]:
    return set(table.loc[table["leak"], ["dataset", "subset"]].itertuples(index=False, name=None))


def test_a_score_leaks_where_its_rows_stand_in_train() -> None:
    table = marked(frame(), LEAKS)
    assert table["leak"].dtype == bool
    assert leaking(table) == {("copied", "validation"), ("copied", "test"), ("calibrated_only", "validation")}


def test_an_interval_leaks_where_its_calibration_rows_do_as_well() -> None:
    table = marked(frame(), LEAKS, calibrated=True)
    both = {(dataset, subset) for dataset in ("copied", "calibrated_only") for subset in SUBSETS}
    assert leaking(table) == both


def test_a_table_without_subsets_is_one_of_test_rows() -> None:
    table = marked(pd.DataFrame({"dataset": list(LEAKS)}), LEAKS)
    assert table["leak"].tolist() == [True, False, False]


def test_an_empty_table_gets_the_column_too() -> None:
    assert marked(pd.DataFrame({"dataset": [], "subset": []}), LEAKS)["leak"].dtype == bool
