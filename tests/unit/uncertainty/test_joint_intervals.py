"""Regions of whole poses: the exact law of their coverage, their form, extrapolation, sessions."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.stats import betabinom, kstest

from softkin.core.errors import SoftkinError
from softkin.core.samples import Array, Samples
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.conformal import conformal_limit, conformal_rank
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.joint_intervals import JointIntervals
from softkin.uncertainty.promise import Promise
from tests.recorded_robot import recorded_arm
from tests.unit.uncertainty.small_robot import small_robot

N, N_NEW, LEVEL = 40, 60, 0.9
#: Errors of two markers, by the shape that fits them.
MIXES = {"ellipsoids": np.kron(np.eye(2), np.array([[1.0, 0.9, 0], [0, 0.3, 0], [0, 0, 2.0]])), "box": np.eye(6)}


class Nowhere:
    """A model that predicts 0: positions are its errors."""

    def predict(self, inputs: Array) -> Array:
        return np.zeros((len(inputs), 6))


def made(kind: str, seed: int = 0, n: int = N) -> tuple[CalibratedModel, Samples]:
    """A robot whose rows are exchangeable, and new rows."""
    rng = np.random.default_rng(seed)
    size = (200 + n + N_NEW, 6)
    positions = (rng.standard_normal(size) if kind == "ellipsoids" else rng.uniform(-1, 1, size)) @ MIXES[kind]
    rows = Samples(rng.uniform(-1, 1, (len(positions), 2)), positions)
    train, validation, new = (rows.take(part) for part in np.split(np.arange(len(positions)), [200, 200 + n]))
    model = FittedModel("arm", MODELS["lr"], "paper", Nowhere(), train)
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], validation), new


@pytest.mark.parametrize("kind", MIXES)
def test_whole_poses_are_held_by_the_exact_law(kind: str) -> None:
    """Over 80 draws the number held of 60 is beta-binomial: rank k of 40, mean k / 41."""
    rank, rng, shares = conformal_rank(N, LEVEL), np.random.default_rng(1), []
    assert rank is not None
    law = betabinom(N_NEW, rank, N + 1 - rank)
    held = []
    for seed in range(80):
        robot, new = made(kind, seed)
        regions = robot.joint_intervals(new.commands, LEVEL)
        assert regions.kind == kind
        held.append(int(np.asarray(regions.contains(new.positions)).sum()))
        shares.append(law.cdf(held[-1] - 1) + rng.uniform() * law.pmf(held[-1]))
    assert kstest(shares, "uniform").pvalue > 1e-3
    assert np.mean(held) / N_NEW == pytest.approx(rank / (N + 1), abs=4 * law.std() / N_NEW / np.sqrt(80))


@pytest.mark.parametrize("kind", MIXES)
def test_the_region_is_what_its_bounds_and_matrices_say(kind: str) -> None:
    robot, new = made(kind)
    regions = robot.joint_intervals(new.commands, [0.5, LEVEL])
    held, bounds = np.asarray(regions.contains(new.positions)), np.asarray(regions.bounds)
    limits = [conformal_limit(robot.joint.scores, level) for level in (0.5, LEVEL)]
    np.testing.assert_array_equal(held, [robot.joint.shape.scores(new.positions) <= limit for limit in limits])
    assert held[1].sum() > held[0].sum()
    within = ((bounds[..., 0] <= new.positions) & (new.positions <= bounds[..., 1])).all(axis=-1)
    assert not (held & ~within).any()
    if kind == "box":
        assert regions.matrices is None
        np.testing.assert_array_equal(held, within)
        return
    assert regions.matrices is not None
    assert regions.matrices.shape == (2, N_NEW, 2, 3, 3)
    assert (within & ~held).any()
    # The farthest point along x of the first marker touches the bound, and is the last that is within.
    matrix = regions.matrices[1, 0, 0]
    tip = np.r_[matrix[:, 0] / np.sqrt(matrix[0, 0]), np.zeros(3)]
    assert tip[0] == pytest.approx(bounds[1, 0, 0, 1])
    rows = robot.joint_intervals(new.commands[:1], LEVEL)
    assert [bool(rows.contains(factor * tip)[0]) for factor in (0.999, 1.001)] == [True, False]


def test_it_answers_as_it_was_asked() -> None:
    robot, new = made("ellipsoids")
    many, one = robot.joint_intervals(new.commands, [0.9, 0.5]), robot.joint_intervals(new.commands, 0.9)
    assert np.shape(many.bounds) == (2, N_NEW, 6, 2)
    np.testing.assert_array_equal(one.bounds, np.asarray(many.bounds)[0])
    assert one.matrices is not None
    assert one.matrices.shape == (N_NEW, 2, 3, 3)
    assert np.shape(one.contains(new.positions)) == (N_NEW,)
    assert repr(many) == "ellipsoids around 60 poses of arm, each whole, at 0.9, 0.5"
    table = pd.DataFrame(new.commands, columns=["u1", "u2"], index=range(5, 5 + N_NEW))
    asked = robot.joint_intervals(table[["u2", "u1"]], [0.9, 0.5])
    assert isinstance(asked.bounds, pd.DataFrame)
    assert isinstance(asked.centre, pd.DataFrame)
    assert list(asked.bounds[0.9].columns)[:2] == ["lower_m1_x", "upper_m1_x"]
    np.testing.assert_array_equal(asked.bounds[0.9].to_numpy().reshape(N_NEW, 6, 2), np.asarray(one.bounds))
    held = asked.contains(pd.DataFrame(new.positions, index=table.index, columns=list(asked.centre.columns)))
    assert isinstance(held, pd.DataFrame)
    np.testing.assert_array_equal(held, np.asarray(many.contains(new.positions)).T)
    single = robot.joint_intervals(table, 0.9).contains(new.positions)
    assert isinstance(single, pd.Series)
    assert single.index.equals(table.index)


@pytest.mark.parametrize("kind", MIXES)
def test_too_few_calibration_rows_give_everything(kind: str) -> None:
    robot, new = made(kind, n=6)
    regions = robot.joint_intervals(new.commands, [0.5, 0.95])
    held = np.asarray(regions.contains(1e9 * new.positions))
    assert not held[0].any()
    assert held[1].all()
    assert np.isinf(np.asarray(regions.bounds)[1]).all()


def test_outside_it_grows_along_a_ray_and_constant_coordinates_stay() -> None:
    robot: Any = small_robot(shells=True)
    ray = np.outer(np.linspace(0.1, 4, 60), [0.6, 0.7])
    outside = np.asarray(robot.is_outside(ray))
    widths = np.ptp(robot.joint_intervals(ray, 0.9).bounds, axis=-1)
    assert 10 < outside.sum() < 55
    np.testing.assert_allclose(widths[~outside], np.broadcast_to(widths[0], (int((~outside).sum()), 3)))
    assert (np.diff(widths[outside], axis=0) >= -1e-9).all()
    assert (widths[-1] > 1.5 * widths[0]).all()
    plain = small_robot()
    flat = np.ptp(np.asarray(plain.joint_intervals(ray, 0.9).bounds), axis=-1)
    np.testing.assert_allclose(flat, np.broadcast_to(flat[0], flat.shape))


def test_it_stays_the_same_through_a_file() -> None:
    robot, new = made("ellipsoids")
    robot.joint_intervals(new.commands, 0.9)
    again = pickle.loads(pickle.dumps(robot))
    np.testing.assert_array_equal(
        again.joint_intervals(new.commands, 0.9).bounds, robot.joint_intervals(new.commands, 0.9).bounds
    )


def recorded() -> CalibratedModel:
    rows = recorded_arm(300, zeros_mm=(0.0, 2.0, -2.0))
    settings = FitSettings({"degree": 2, "alpha": 1e-3}, True, 0, 1, memory={"memory": "none", "zeros": True})
    train, rest = rows.take(np.arange(0, 300, 2)), rows.take(np.arange(1, 300, 2))
    model = FittedModel("arm", MODELS["ridge"], "tuned", fitted_model(MODELS["ridge"], settings, train), train)
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], rest)


def test_a_session_never_seen_has_boxes_and_a_recalibrated_one_its_shape() -> None:
    robot, rows = recorded(), recorded_arm(300, zeros_mm=(0.0, 2.0, -2.0))
    known = robot.joint_intervals(rows.inputs[:40], 0.9)
    unseen = robot.joint_intervals(rows.commands[:40], 0.9)
    assert unseen.kind == "box"
    widths = [np.ptp(np.asarray(one.bounds), axis=-1)[0] for one in (known, unseen)]
    assert widths[1][0] > 3 * widths[0][0]
    assert np.mean(np.asarray(known.contains(rows.positions[:40]))) > 0.8
    moved = rows.positions + np.array([5.0, 0.0, 0.0])
    inside = ~np.asarray(robot.is_outside(rows.commands[:10]))
    again = robot.recalibrate(rows.commands[:10][inside], moved[:10][inside])
    held: JointIntervals = again.joint_intervals(rows.commands[:40], 0.9)
    assert held.kind == known.kind
    assert np.mean(np.asarray(held.contains(moved[:40]))) > 0.8
    assert not np.asarray(robot.joint_intervals(rows.inputs[:40], 0.9).contains(moved[:40])).any()
    single = np.ptp(np.asarray(again.intervals(rows.commands[:1], 0.9)), axis=-1)
    assert (np.ptp(np.asarray(held.bounds), axis=-1)[0] > single).all()


def test_positions_of_other_rows_are_refused() -> None:
    robot, new = made("box")
    table = pd.DataFrame(new.commands, columns=["u1", "u2"])
    positions = pd.DataFrame(new.positions, columns=[f"m{m}_{axis}" for m in (1, 2) for axis in "xyz"])
    for commands, other in ((new.commands, new.positions[:3]), (table, positions[::-1])):
        with pytest.raises(SoftkinError) as caught:
            robot.joint_intervals(commands, 0.9).contains(other)
        assert caught.value.where == "arm"


def test_a_changed_scale_of_the_calibration_set_scales_the_region() -> None:
    robot, new = made("box")
    wide = replace(robot, joint=replace(robot.joint, scores=2 * robot.joint.scores))
    widths = [np.ptp(np.asarray(one.joint_intervals(new.commands, 0.9).bounds), axis=-1) for one in (robot, wide)]
    np.testing.assert_allclose(widths[1], 2 * widths[0])


def test_where_blocks_are_exchangeable_the_size_counts_them() -> None:
    """With K blocks of M rows a level c asks for the score of rank c (K + 1) M, as intervals do."""
    robot, new = made("box", n=60)
    n = len(robot.joint.scores)
    blocks = replace(robot, joint=replace(robot.joint, promise=Promise(n // 2, 2)))
    scores = np.sort(robot.joint.scores)
    for level in (0.5, 0.8, 0.9):
        sides = np.asarray(blocks.joint_intervals(new.commands[:1], level).bounds)[0]
        moving = blocks.joint.moving
        size = np.ptp(sides, axis=1)[moving] / 2 / blocks.joint.shape.half_widths
        rank = int(np.ceil(round(level * (n // 2 + 1) * 2, 9)))
        np.testing.assert_allclose(size, scores[rank - 1])
        np.testing.assert_allclose(blocks.box(level), np.ptp(sides, axis=1) / 2)
        assert rank > np.ceil(level * (n + 1)) - 1
