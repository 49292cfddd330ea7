from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from softkin.core.metrics.interval import covered
from softkin.core.samples import Samples
from softkin.core.shells import command_norm, outer_shells
from softkin.models import MODELS
from softkin.training.fit import fit_quietly, kinematic_model
from softkin.uncertainty.calibration_data import Evidence, Shell, ShellEvidence
from softkin.uncertainty.conformal import conformal_rank
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.in_domain_and_extrapolation import outside
from softkin.uncertainty.intervals.split_conformal_distance import distances
from tests.conftest import bending_arm
from tests.unit.intervals.test_engines import LEVELS, shell_evidence


def half_by_hand(evidence: ShellEvidence, place: int, level: float) -> np.ndarray:
    shell = evidence.shells[place]
    scores = np.sort(np.abs(shell.truth - shell.predicted), axis=0)
    rank = conformal_rank(len(scores), level)
    assert rank is not None
    return scores[rank - 1]


@pytest.mark.parametrize("method", ["shell", "shell_matched"])
def test_a_shell_sets_one_width_around_the_deployed_model(method: str) -> None:
    evidence = shell_evidence(88)
    found = INTERVAL_METHODS[method].intervals(evidence, LEVELS)
    np.testing.assert_allclose(found.mean(axis=-1), np.broadcast_to(evidence.deployed.new, found.shape[:-1]))
    shares = [len(s.core_commands) / (len(s.core_commands) + len(s.commands)) for s in evidence.shells]
    reach = evidence.norm(evidence.deployed.train_commands).max()  # type: ignore[arg-type]
    beyond = evidence.norm(evidence.deployed.new_commands).max() / reach  # type: ignore[arg-type]
    ratios = [reach / evidence.norm(s.core_commands).max() for s in evidence.shells]
    place = int(np.argmin(np.abs(np.subtract(shares, 0.7)) if method == "shell" else np.abs(np.log(ratios / beyond))))
    for level, bounds in zip(LEVELS, found, strict=True):
        expected = np.broadcast_to(2 * half_by_hand(evidence, place, level), bounds.shape[:-1])
        np.testing.assert_allclose(bounds[..., 1] - bounds[..., 0], expected)


def test_one_interval_is_split_conformal_inside_and_never_narrower_outside() -> None:
    evidence = shell_evidence(88)
    one, split, rolling = (
        INTERVAL_METHODS[name].intervals(given, LEVELS)
        for name, given in (("auto", evidence), ("scp_mapie", evidence.deployed), ("rolling_shells", evidence))
    )
    out = outside(evidence)
    assert out.tolist() == [False] * 20 + [True] * 20
    np.testing.assert_allclose(one[:, ~out], split[:, ~out], atol=1e-9)
    width, least, by_shells = (np.diff(bounds, axis=-1)[:, out] for bounds in (one, split, rolling))
    np.testing.assert_allclose(width, np.maximum(least, by_shells), atol=1e-9)


def test_a_method_of_inside_that_grows_with_the_distance_has_no_say_outside() -> None:
    """A real finger's errors do not grow with it: intervals were four times as wide as the oracle's."""
    evidence = shell_evidence(88)
    grown = INTERVAL_METHODS["scp_distance"].intervals(evidence.deployed, LEVELS)
    found = INTERVAL_METHODS["auto"].intervals(replace(evidence, inside=grown), LEVELS)
    out = outside(evidence)
    np.testing.assert_array_equal(found[:, ~out], grown[:, ~out])
    np.testing.assert_array_equal(found[:, out], INTERVAL_METHODS["auto"].intervals(evidence, LEVELS)[:, out])


def test_outside_a_noisy_arm_is_held_far_oftener_than_by_split_conformal_prediction() -> None:
    """Mean over 10 arms, a Gaussian process each: noise hides how errors grow, so that 90 % is nearly reached."""

    def process(train: Samples) -> Any:
        params = {"kernel": "rbf", "trend": "linear", "max_iter": 15}
        estimator = kinematic_model(MODELS["gp"], params, skip_constant=True, seed=0, threads=1)
        fit_quietly(estimator, train, 1)
        return estimator

    def held(seed: int) -> list[float]:
        train, validation = (bending_arm(150, seed=10 * seed + place) for place in (0, 1))
        far = bending_arm(300, seed=10 * seed + 2, reach=1.6)
        norm, whole = command_norm(train.commands, standardised=False).of, process(train)
        shells = []
        for core, shell in outer_shells(norm(train.commands), (0.6, 0.7, 0.8, 0.9)):
            predicted = process(Samples(train.commands[core], train.positions[core])).predict(train.commands[shell])
            shells.append(Shell(train.commands[core], train.commands[shell], predicted, train.positions[shell]))
        evidence = Evidence(
            whole.predict(validation.commands),
            validation.positions,
            whole.predict(far.commands),
            train_commands=train.commands,
            calibration_commands=validation.commands,
            new_commands=far.commands,
        )
        both = ShellEvidence(evidence, shells, norm)
        found = [
            INTERVAL_METHODS[name].intervals(one, [0.9])[0] for name, one in (("auto", both), ("scp_mapie", evidence))
        ]
        return [float(covered(far.positions, bounds)[outside(both)].mean()) for bounds in found]

    ours, split = np.mean([held(seed) for seed in range(10)], axis=0)
    assert ours > 0.86
    assert split < 0.6


def test_of_rows_like_those_of_train_hardly_any_lies_outside() -> None:
    """At most 2 / (n + 1) of them on average, over 400 draws of 30 rows and 20 new ones."""
    evidence, n, n_new = shell_evidence(88), 30, 20
    rng, counts = np.random.default_rng(1), []
    for _ in range(400):
        rows = rng.uniform(-1, 1, (n + n_new, 2))
        deployed = replace(evidence.deployed, train_commands=rows[:n], new_commands=rows[n:])
        counts.append(outside(replace(evidence, deployed=deployed)).mean())
    mean, error = np.mean(counts), np.std(counts) / np.sqrt(len(counts))
    assert 0 < mean <= 2 / (n + 1) + 3 * error


def test_a_command_in_a_hole_of_train_is_outside() -> None:
    evidence = shell_evidence(88)
    assert evidence.deployed.train_commands is not None
    assert evidence.deployed.new_commands is not None
    far = evidence.norm(evidence.deployed.train_commands) > 0.5
    evidence.deployed.new_commands[0] = 0.0
    assert not outside(evidence)[0]
    object.__setattr__(evidence.deployed, "train_commands", evidence.deployed.train_commands[far])
    assert outside(evidence)[0]


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 50),
    n_commands=st.integers(1, 4),
    direction=st.lists(st.floats(-1, 1), min_size=4, max_size=4),
)
def test_the_difficulty_never_shrinks_along_a_ray_that_leaves_the_box(
    seed: int, n_commands: int, direction: list[float]
) -> None:
    rng = np.random.default_rng(seed)
    train = rng.uniform(-1, 1, (60, n_commands)) ** 3 * [1.0, 10.0, 100.0, 1000.0][:n_commands]
    heading = np.array(direction[:n_commands]) + 1e-3
    start = rng.uniform(train.min(axis=0), train.max(axis=0))
    ray = start + np.linspace(0, 8, 200)[:, None] * heading * train.std(axis=0)
    (found,) = distances(train, [ray])
    inside = ((ray >= train.min(axis=0)) & (ray <= train.max(axis=0))).all(axis=1)
    last = int(np.flatnonzero(inside)[-1])
    assert (np.diff(found[last:]) >= -1e-9).all()
