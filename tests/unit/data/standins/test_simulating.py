"""Whole stand-ins: sizes, splitting, seeds."""

from __future__ import annotations

import numpy as np
import pytest
import yaml
from scipy.stats import ks_2samp

from softkin.core.errors import ConfigError
from softkin.core.samples import EXTRAPOLATION, SUBSETS, Samples, informative_coordinates
from softkin.data.standins import STANDINS
from softkin.data.standins.simulating import simulate, split, subset_sizes
from tests.conftest import HOUSE

SIZES = {"train": 24, "validation": 5, "test": 6, "extrapolation": 12}


@pytest.fixture(scope="module", params=STANDINS)
def robot(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def simulated(robot: str) -> dict[str, Samples]:
    return simulate(robot, n_rows=SIZES, seed=5)


def test_the_registry_names_itself() -> None:
    assert all(name == spec.name for name, spec in STANDINS.items())


def test_sizes_shapes_and_types(robot: str, simulated: dict[str, Samples]) -> None:
    assert {subset: len(rows) for subset, rows in simulated.items()} == SIZES
    assert tuple(simulated) == SUBSETS
    for rows in simulated.values():
        assert rows.commands.shape[1] == STANDINS[robot].n_commands
        assert rows.positions.shape == (len(rows), 3 * STANDINS[robot].n_markers)
        assert rows.commands.dtype == rows.positions.dtype == np.float64
        assert np.isfinite(rows.positions).all()


def test_commands_are_distinct_over_all_subsets(simulated: dict[str, Samples]) -> None:
    commands = np.vstack([rows.commands for rows in simulated.values()])
    assert len(np.unique(commands, axis=0)) == sum(SIZES.values())


def test_no_two_poses_are_alike(simulated: dict[str, Samples]) -> None:
    positions = np.vstack([rows.positions for rows in simulated.values()])
    assert len(np.unique(positions.round(6), axis=0)) == sum(SIZES.values())


def test_extrapolation_is_the_outer_shell(simulated: dict[str, Samples]) -> None:
    norms = {subset: np.linalg.norm(rows.commands, axis=1) for subset, rows in simulated.items()}
    inner = max(norms[subset].max() for subset in SUBSETS if subset != EXTRAPOLATION)
    assert norms[EXTRAPOLATION].min() >= inner


def test_the_inner_rows_are_dealt_at_random() -> None:
    """Train and test come from the same distribution, in norm and in the order of sending."""
    commands = np.random.default_rng(0).uniform(-1, 1, (3000, 2))
    rows = split(commands, subset_sizes(3000), np.random.default_rng(1))
    assert sorted(np.concatenate(list(rows.values())).tolist()) == list(range(3000))
    norms = np.linalg.norm(commands, axis=1)
    for held_out in ("validation", "test"):
        assert ks_2samp(norms[rows["train"]], norms[rows[held_out]]).pvalue > 1e-6
        assert ks_2samp(rows["train"], rows[held_out]).pvalue > 1e-6
    # The first rows of a subset stand for all of it: `max_rows_per_subset` keeps those.
    first, last = np.array_split(rows["extrapolation"], 2)
    assert ks_2samp(norms[first], norms[last]).pvalue > 1e-6


def test_only_the_base_of_the_arm_stands_still(robot: str, simulated: dict[str, Samples]) -> None:
    moving = informative_coordinates(simulated["train"].positions)
    still = 3 if STANDINS[robot].n_markers > 1 else 0
    assert moving.tolist() == [False] * still + [True] * (len(moving) - still)


def test_the_seed_decides_every_bit(robot: str, simulated: dict[str, Samples]) -> None:
    again, other = simulate(robot, n_rows=SIZES, seed=5), simulate(robot, n_rows=SIZES, seed=6)
    for subset, rows in simulated.items():
        assert rows.commands.tobytes() == again[subset].commands.tobytes()
        assert rows.positions.tobytes() == again[subset].positions.tobytes()
        assert not np.isin(rows.commands, other[subset].commands).any()


def test_a_total_is_split_as_the_published_data_are() -> None:
    """Within a row of what the published files hold."""
    sources = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]
    for source in sources.values():
        sizes = subset_sizes(sum(source["rows"].values()))
        assert sum(sizes.values()) == sum(source["rows"].values())
        assert all(abs(sizes[subset] - source["rows"][subset]) <= 2 for subset in SUBSETS)


def test_a_total_is_enough() -> None:
    simulated = simulate("tendon_finger", n_rows=100, seed=0)
    assert {subset: len(rows) for subset, rows in simulated.items()} == {
        "train": 56,
        "validation": 7,
        "test": 7,
        "extrapolation": 30,
    }


@pytest.mark.parametrize(
    ("name", "n_rows", "says"),
    [
        ("snake", 100, "stand-in 'snake': unknown[\\s\\S]*pneumatic_arm"),
        ("tendon_finger", {"train": 5}, "every subset needs a row"),
        ("tendon_finger", {**SIZES, "test": 0}, "every subset needs a row"),
        ("tendon_finger", 4, "every subset needs a row[\\s\\S]*fix: "),
    ],
)
def test_what_cannot_be_simulated_is_an_error(name: str, n_rows: int | dict[str, int], says: str) -> None:
    with pytest.raises(ConfigError, match=says):
        simulate(name, n_rows=n_rows, seed=0)
