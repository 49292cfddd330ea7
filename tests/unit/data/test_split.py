from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from softkin.core.errors import DataError
from softkin.core.samples import SUBSETS
from softkin.data.split import EXTRAPOLATION_SHARE, has_standardised_norm, split, standardised_norms, wanted_shares

TRAIN, VALIDATION, TEST, EXTRAPOLATION = range(4)


def line(row: int) -> str:
    return f"line {row + 2}"


def run(commands: Any, values: Any = None, /, **options: Any) -> Any:
    return split(options, np.asarray(commands, float), None if values is None else np.asarray(values, object), line)


def cloud(n_rows: int, seed: int = 0) -> Any:
    return np.random.default_rng(seed).normal(size=(n_rows, 3)) * [1.0, 100.0, 0.01] + [5.0, 0.0, -3.0]


def test_random_gives_the_outer_shell_and_the_wanted_shares() -> None:
    commands = cloud(1000)
    subset_of = run(commands, method="random")
    assert np.bincount(subset_of).tolist() == [560, 70, 70, 300]
    norms = np.linalg.norm((commands - commands.mean(axis=0)) / commands.std(axis=0), axis=1)
    assert norms[subset_of == EXTRAPOLATION].min() > norms[subset_of != EXTRAPOLATION].max()
    assert wanted_shares({"method": "random"}) == pytest.approx(
        dict(zip(SUBSETS, (0.56, 0.07, 0.07, 0.3), strict=True))
    )


def test_the_share_of_the_shell_can_be_named() -> None:
    assert np.bincount(run(cloud(1000), method="random", extrapolation_share=0.1)).tolist() == [720, 90, 90, 100]


def test_the_seed_decides_and_moves_no_row_of_the_shell() -> None:
    first, again, other = (run(cloud(400), method="random", seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()
    np.testing.assert_array_equal(first == EXTRAPOLATION, other == EXTRAPOLATION)


def test_each_inner_row_is_as_likely_in_test_as_any_other() -> None:
    """Over 400 seeds a row is in `test` 7 / 70 of the time, each count within the exact band at 1e-6 per row."""
    from scipy.stats import binom

    commands = cloud(100)
    counts = sum((run(commands, method="random", seed=seed) == TEST).astype(int) for seed in range(400))
    inner = run(commands, method="random") != EXTRAPOLATION
    low, high = binom.interval(1 - 1e-6, 400, 0.1)
    assert (counts[inner] >= low).all()
    assert (counts[inner] <= high).all()
    assert (counts[~inner] == 0).all()


def test_rows_of_one_command_stay_together() -> None:
    distinct = cloud(60)
    commands = np.repeat(distinct, 5, axis=0)[np.random.default_rng(1).permutation(300)]
    subset_of = run(commands, method="random")
    for command in distinct:
        assert len(set(subset_of[(commands == command).all(axis=1)])) == 1
    assert set(subset_of) == {0, 1, 2, 3}


def test_a_constant_command_and_a_scale_change_nothing() -> None:
    commands = cloud(200)
    wider = np.column_stack([commands, np.full(200, 3.0)]) * [1e-200, 1.0, 1e90, 7.0]
    np.testing.assert_array_equal(run(commands, method="random"), run(wider, method="random"))
    assert (standardised_norms(np.ones((3, 2))) == 0).all()


labels = st.lists(st.integers(0, 12), min_size=12, max_size=50)


@given(labels, st.integers(0, 2**32), st.sampled_from(["group", "time"]))
def test_no_group_and_no_time_straddles_two_subsets(values: list[int], seed: int, method: str) -> None:
    commands = cloud(len(values), seed=seed)
    column = [f"trial {value}" for value in values] if method == "group" else [str(value) for value in values]
    if len(set(values)) < 4:
        with pytest.raises(DataError, match="\n  fix: "):
            run(commands, column, method=method, column="by", seed=seed)
        return
    subset_of = run(commands, column, method=method, column="by", seed=seed)
    assert set(subset_of.tolist()) == {TRAIN, VALIDATION, TEST, EXTRAPOLATION}
    for value in set(values):
        assert len(set(subset_of[np.asarray(values) == value])) == 1


def test_outer_groups_reach_farther_than_all_others() -> None:
    commands, groups = cloud(500), np.arange(500) // 10
    subset_of = run(commands, [str(group) for group in groups], method="group", column="trial")
    norms = standardised_norms(commands)
    largest = np.array([norms[groups == group].max() for group in range(50)])
    outer = subset_of[::10] == EXTRAPOLATION
    assert largest[outer].min() > largest[~outer].max()
    assert outer.sum() == 15


@pytest.mark.parametrize(
    "times",
    [
        [str(row / 10) for row in range(200)],
        [f"{row / 10}".replace(".", ",") for row in range(200)],
        [f"2024-05-31T12:{row // 60:02}:{row % 60:02}.25" for row in range(200)],
    ],
)
def test_time_keeps_stretches_together_in_any_order_of_rows(times: list[str]) -> None:
    order = np.random.default_rng(0).permutation(200)
    subset_of = run(cloud(200)[order], np.array(times, object)[order], method="time", column="t", blocks=20)
    in_order = subset_of[np.argsort(order)].reshape(20, 10)
    assert (in_order == in_order[:, :1]).all()
    assert set(in_order[:, 0]) == {0, 1, 2, 3}


def test_times_may_be_numbers_already() -> None:
    commands, times = cloud(200), np.arange(200)
    options = {"method": "time", "column": "t"}
    np.testing.assert_array_equal(split(options, commands, times, line), run(commands, [*map(str, times)], **options))


@pytest.mark.parametrize(
    ("spelt", "names"),
    [
        (["train", "validation", "test", "extrapolation"], None),
        (["train", " val ", "test", "ext"], None),
        (["0", "1", "2", "3"], {"train": 0, "validation": 1, "test": 2, "extrapolation": 3}),
        (["A", "B", "C", "D"], {"train": "A", "validation": "B", "test": "C", "extrapolation": "D"}),
    ],
)
def test_a_column_may_name_the_subsets(spelt: list[str], names: dict[str, Any] | None) -> None:
    options = {} if names is None else {"names": names}
    rows = [3, 0, 1, 2, 2, 0]
    subset_of = run(cloud(6), [spelt[row] for row in rows], method="column", column="part", **options)
    assert subset_of.tolist() == rows
    assert wanted_shares({"method": "column"}) == {}


@pytest.mark.parametrize(
    ("attempt", "says"),
    [
        (lambda: run(cloud(5), ["train", "val", "tst", "test", "ext"], method="column", column="part"),
         ["line 4, column 'part': 'tst' is the name of no subset", "`names`"]),
        (lambda: run(cloud(3), ["train", "val", "train"], method="column", column="part"),
         ["column 'part': no row of test or extrapolation"]),
        (lambda: run(cloud(4), ["a", "b", " ", "c"], method="group", column="trial"),
         ["line 4, column 'trial': no value", "fill the cell"]),
        (lambda: run(cloud(4), [1.0, 2.0, np.nan, 3.0], method="group", column="trial"),
         ["line 4, column 'trial': no value, so the group of the row is unknown"]),
        (lambda: run(cloud(4), [1.0, 2.0, np.nan, 3.0], method="time", column="t"),
         ["line 4, column 't': no value, so the time of the row is unknown"]),
        (lambda: run(cloud(4), ["1", "2", "soon", "4"], method="time", column="t"),
         ["line 4, column 't': 'soon' is no time", "numbers (seconds)"]),
        (lambda: run(cloud(9), ["a", "b", "c"] * 3, method="group", column="trial"),
         ["column 'trial': 3 groups, but four subsets need at least four"]),
        (lambda: run(np.ones((50, 2)), method="random"), ["1 distinct command, but", "record more"]),
        (lambda: run([[np.cos(a), np.sin(a)] for a in np.arange(40) * np.pi / 20], method="random"),
         ["extrapolation would be empty: of 40 distinct commands"]),
        (lambda: run(np.repeat(np.eye(2) * 2 - 1, 30, axis=0), method="random"), ["2 distinct commands, but"]),
    ],
)  # fmt: skip
def test_an_impossible_split_is_an_error(attempt: Callable[[], Any], says: list[str]) -> None:
    with pytest.raises(DataError) as error:
        attempt()
    for part in ("\n  fix: ", *says):
        assert part in str(error.value)


def test_a_coarse_grid_of_commands_is_cut_where_it_comes_nearest() -> None:
    grid = np.array([[a, b] for a in (-1, 0, 1) for b in (-1, 0, 1)], float)
    subset_of = run(np.repeat(grid, 20, axis=0), method="random")
    corners = np.abs(np.repeat(grid, 20, axis=0)).sum(axis=1) == 2
    np.testing.assert_array_equal(subset_of == EXTRAPOLATION, corners)
    assert EXTRAPOLATION_SHARE == 0.3


def test_the_norm_is_standardised_where_softkin_splits() -> None:
    assert has_standardised_norm({"format": "table_file", "split": {"method": "random"}})
    assert not has_standardised_norm({"format": "kinn_json"})
