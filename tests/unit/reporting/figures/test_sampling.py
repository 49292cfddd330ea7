"""Of a subset of very many rows, figures draw a sample, and say so."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.data.table import read_subset
from softkin.reporting.figures import FIGURES, sampling
from softkin.reporting.figures.sampling import MOST_ROWS, drawn_rows, evenly_spaced, sample_notes
from softkin.reporting.figures.spec import DatasetResults

#: Figures with a row of their frame for each row that is drawn, and those whose numbers are of all rows.
OF_DRAWN_ROWS = ("workspace_predictions", "position_curves", "distance", "workspace", "width")
OF_ALL_ROWS = ("robot", "intervals_paper", "intervals_deployed")
NOTE = "test: 25 of 40 rows are drawn, a random sample"


def test_all_rows_are_drawn_of_a_subset_that_is_not_large() -> None:
    np.testing.assert_array_equal(drawn_rows(MOST_ROWS), np.arange(MOST_ROWS))
    np.testing.assert_array_equal(evenly_spaced(MOST_ROWS), np.arange(MOST_ROWS))


def test_a_sample_is_the_same_each_time_and_holds_the_rows_that_are_kept() -> None:
    rows = drawn_rows(3 * MOST_ROWS)
    assert len(rows) == len(set(rows)) == MOST_ROWS
    assert (np.diff(rows) > 0).all()
    assert rows.max() > 2.9 * MOST_ROWS
    kept = np.setdiff1d(np.arange(3 * MOST_ROWS), rows)[:7]
    np.testing.assert_array_equal(drawn_rows(3 * MOST_ROWS, kept), np.union1d(rows, kept))


def test_evenly_spaced_rows_hold_the_first_and_the_last() -> None:
    rows = evenly_spaced(10 * MOST_ROWS + 1)
    assert (len(rows), rows[0], rows[-1]) == (MOST_ROWS, 0, 10 * MOST_ROWS)
    assert set(np.diff(rows)) <= {10, 11}


def test_a_note_for_each_subset_of_which_a_sample_is_drawn(
    results: DatasetResults, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert sample_notes(results, ["test"]) == []
    monkeypatch.setattr(sampling, "MOST_ROWS", 25)
    assert sample_notes(results, ["test"]) == [NOTE]


@pytest.mark.parametrize("name", [*OF_DRAWN_ROWS, *OF_ALL_ROWS])
def test_figures_of_many_rows_draw_a_sample_and_say_so(
    name: str, results: DatasetResults, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sampling, "MOST_ROWS", 25)
    frame = FIGURES[name].frame(results)
    key = ["model", "preset", "interval_method", *({"subset"} & set(frame))]
    sizes = frame[frame["subset"] == "test"].groupby(key).size() if "subset" in frame else frame.groupby(key).size()
    if name in OF_ALL_ROWS:
        assert set(sizes) == {40}
    else:
        assert 25 <= sizes.min() <= sizes.max() < 40
    assert NOTE in FIGURES[name].plot(frame, results).get_suptitle()


def test_the_range_and_the_edge_of_train_are_those_of_all_rows(
    results: DatasetResults, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sampling, "MOST_ROWS", 5)
    train = read_subset(results.table, "train")
    rows = FIGURES["workspace"].frame(results)
    commands = rows.loc[rows["subset"] == "train", ["u1", "u2"]]
    np.testing.assert_array_equal(commands.min(), train.commands.min(axis=0))
    np.testing.assert_array_equal(commands.max(), train.commands.max(axis=0))
    rows = FIGURES["workspace_predictions"].frame(results)
    edge = rows.loc[rows["subset"] == "train", ["true_1", "true_2"]]
    shown = [int(rows[f"axis_{n}"].iloc[0] == f"m1_{axis}") * place for n in (1, 2) for place, axis in enumerate("xyz")]
    assert len(edge) < 2 * len(train)
    for n, place in ((1, sum(shown[:3])), (2, sum(shown[3:]))):
        assert edge[f"true_{n}"].min() == train.positions[:, place].min()
        assert edge[f"true_{n}"].max() == train.positions[:, place].max()
