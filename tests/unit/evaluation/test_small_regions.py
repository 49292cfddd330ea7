"""The worst small region is found where intervals miss, confirmed on other rows, and none is made up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from softkin.core.samples import Array
from softkin.evaluation import small_regions
from softkin.evaluation.small_regions import FEWEST_ROWS, Region, deployed_rows, share, worst_region
from tests.unit.uncertainty.small_robot import small_robot
from tests.unit.uncertainty.test_failures import SLAB, failing, in_slab, robot


def drawn(n_rows: int, seed: int = 0) -> tuple[Array, Array]:
    """Three commands, and rows that miss in one of ten cases."""
    rng = np.random.default_rng(seed)
    return rng.uniform(-1, 1, (n_rows, 3)), (rng.uniform(size=n_rows) < 0.1).astype(float)


def test_a_thin_slab_is_found_along_its_command() -> None:
    commands, missed = drawn(800)
    missed[(commands[:, 1] > 0.3) & (commands[:, 1] < 0.36)] = 1.0
    region = worst_region(commands, missed, 1)
    assert region is not None
    assert region.columns == (1,)
    assert region.low[0] == pytest.approx(0.3, abs=0.03)
    assert region.high[0] == pytest.approx(0.36, abs=0.03)
    assert str(region).startswith("u2 0.")


def test_of_many_commands_pairs_are_tried_of_those_that_are_worst_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """All pairs of 256 commands would take minutes."""
    rng = np.random.default_rng(0)
    commands, missed = rng.uniform(-1, 1, (1000, 12)), (rng.uniform(size=1000) < 0.1).astype(float)
    missed[(commands[:, 4] > 0.5) & (commands[:, 9] < -0.5)] = 1.0
    tried: list[tuple[int, ...]] = []
    along = small_regions._along

    def counted(rows: Array, columns: tuple[int, ...], excess: Array) -> object:
        tried.append(columns)
        return along(rows, columns, excess)

    monkeypatch.setattr(small_regions, "_along", counted)
    whole = worst_region(commands, missed, 2)
    assert len(tried) == 66
    tried.clear()
    monkeypatch.setattr(small_regions, "MOST_COMMANDS", 4)
    few = worst_region(commands, missed, 2)
    assert whole is not None
    assert few is not None
    assert few.columns == whole.columns == (4, 9)
    np.testing.assert_array_equal([few.low, few.high], [whole.low, whole.high])
    assert len(tried) == 12 + 6


def test_a_corner_is_found_along_two_commands() -> None:
    commands, missed = drawn(1000)
    corner = (commands[:, 0] > 0.6) & (commands[:, 2] < -0.6)
    missed[corner] = 1.0
    region = worst_region(commands, missed, 2)
    assert region is not None
    assert region.columns == (0, 2)
    new, _ = drawn(4000, seed=1)
    right = (new[:, 0] > 0.6) & (new[:, 2] < -0.6)
    assert (region.holds(new) == right).mean() > 0.97


@pytest.mark.parametrize("n_columns", [1, 2])
def test_it_is_small_but_has_rows_enough(n_columns: int) -> None:
    for seed in range(5):
        commands, missed = drawn(300, seed)
        region = worst_region(commands, missed, n_columns)
        assert region is not None
        assert FEWEST_ROWS <= region.holds(commands).sum() <= 150


def test_copied_commands_are_never_split() -> None:
    commands, missed = np.repeat(np.arange(8.0), 25)[:, None], np.repeat([0, 0, 0, 1, 0, 0, 0, 0], 25)
    region = worst_region(commands, missed, 1)
    assert region is not None
    assert (region.low[0], region.high[0]) == (3.0, 3.0)


def test_where_nothing_can_be_found_there_is_none() -> None:
    commands, missed = drawn(300)
    assert worst_region(commands, np.zeros(300), 1) is None
    assert worst_region(commands[:39], missed[:39], 1) is None
    assert worst_region(commands[:, :1], missed, 2) is None


def test_the_worst_of_many_is_not_worse_than_others_on_rows_that_it_was_not_picked_on() -> None:
    found = []
    for seed in range(30):
        commands, missed = drawn(200, seed)
        region = worst_region(commands, missed, 1)
        assert region is not None
        new, missed_new = drawn(2000, seed + 100)
        found.append((missed[region.holds(commands)].mean(), missed_new[region.holds(new)].mean()))
    picked, fresh = np.mean(found, axis=0)
    assert picked > 0.2
    assert fresh == pytest.approx(0.1, abs=0.02)


def test_rows_on_the_deployed_model_say_where_it_fails() -> None:
    """Where it knows nothing of failures the slab is the worst region; where it does, the slab is told apart."""
    validation, test = failing(1500, 11)[0], failing(1500, 12)[0]
    bare = pd.DataFrame(deployed_rows(replace(small_robot(), failures=None), validation, test, 0.9))
    assert bare["by"].tolist() == ["small_region", "small_region"]
    name, low, _, high = bare["group"][0].split()
    assert name == "u1"
    assert [float(low), float(high)] == pytest.approx(list(SLAB), abs=0.02)
    assert bare["coverage"][0] < 0.5
    assert bare["n_rows"][0] > FEWEST_ROWS
    knowing = pd.DataFrame(deployed_rows(robot(), validation, test, 0.9)).set_index("group")
    assert knowing.loc[["may fail", "others"], "n_rows"].sum() == 1500
    assert knowing.loc["may fail", "n_rows"] == pytest.approx(in_slab(test.commands).sum(), abs=12)
    assert knowing.loc["may fail", "coverage"] > 0.95
    assert knowing.loc["may fail", "value"] > 0.5 > 0.01 > knowing.loc["others", "value"]


def test_no_rows_have_no_share() -> None:
    assert share(np.zeros(0))["n_rows"] == 0
    assert np.isnan(share(np.zeros(0))["coverage"])
    region = Region((0,), np.array([0.0]), np.array([1.0]))
    assert region.holds(np.array([[0.5], [1.0], [1.1]])).tolist() == [True, True, False]
