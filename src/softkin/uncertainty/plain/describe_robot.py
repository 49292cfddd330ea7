"""What a calibrated model is in plain numbers: `PlainRobot` answers from them, in process and in exported files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from softkin.core.errors import ConfigError
from softkin.core.samples import Samples
from softkin.core.shells import CommandNorm
from softkin.models.estimators.in_sessions import InSessions
from softkin.models.estimators.memory_features import NONE, PLAY, WIDTH_SETS
from softkin.models.plain.describe import described, standardised
from softkin.models.plain.describe_spaces import described_space
from softkin.models.plain.kernels import Node
from softkin.uncertainty.beyond import Beyond
from softkin.uncertainty.error_growth import ErrorGrowth


def estimator_numbers(estimator: Any, train: Samples, *, has_spread: bool) -> Node:
    """`members`, a regressor and a target space each, and their `shares` of a fitted estimator of positions; with the
    numbers of its spread where it `has_spread`.

    Raises:
        ConfigError: it has a part that cannot be written as plain numbers.
    """
    name = type(estimator).__name__
    if name not in POSITION_DESCRIBERS:
        raise ConfigError(
            f"a {name} cannot be written as plain numbers",
            where=name,
            fix=f"use one of these: {', '.join(POSITION_DESCRIBERS)}",
        )
    return POSITION_DESCRIBERS[name](estimator, train, has_spread)


def of_one(estimator: Any, train: Samples, has_spread: bool) -> Node:
    """Of a KinematicRegressor, alone or in InSessions."""
    model, features, added = estimator.resolved(train.inputs)
    scaler, regressor = (step for _, step in model.regressor_.steps)
    known = None
    if has_spread:
        known = Samples(scaler.transform(features), model.transformer_.transform(train.positions - added))
    node = standardised(scaler, described(regressor, known))
    member = {"regressor": node, "space": described_space(model.transformer_), **_told(estimator)}
    return {"members": [member], "shares": np.ones(1)}


def of_mean(estimator: Any, train: Samples, has_spread: bool) -> Node:
    """Of a weighted mean of estimators of positions."""
    parts = [estimator_numbers(member, train, has_spread=has_spread) for member in estimator.members]
    shares = [weight * part["shares"] for weight, part in zip(estimator.weights, parts, strict=True)]
    return {"members": [member for part in parts for member in part["members"]], "shares": np.concatenate(shares)}


def _told(estimator: Any) -> Node:
    """What a member is told of earlier commands: the step from the one before, and play operators by their places."""
    is_told = isinstance(estimator, InSessions)
    widths = WIDTH_SETS[estimator.widths] if is_told and estimator.memory == PLAY else ()
    return {"has_step": is_told and estimator.memory != NONE, "widths": np.array(widths, dtype=np.int64)}


def memory_numbers(estimator: Any) -> Node | None:
    """How a robot remembers, and the zeros of its sessions; None where the command alone decides."""
    if not isinstance(estimator, InSessions):
        return None
    return {
        "rest": np.asarray(estimator.robot.rest, dtype=np.float64),
        "halves": estimator.robot.half_widths(),
        "sessions": estimator.sessions_,
        "zeros": estimator.zeros_,
    }


def place_numbers(beyond: Beyond) -> Node:
    """What tells commands that lie outside, and how far; without a `centre`, the command norm is none of softkin's."""
    surroundings = beyond.surroundings
    node: Node = {
        "mean": surroundings.mean,
        "scale": surroundings.scale,
        "points": surroundings.points,
        "gap": surroundings.gap,
        "radius": beyond.radius,
    }
    owner = getattr(beyond.norm, "__self__", None)
    if isinstance(owner, CommandNorm):
        varies = np.flatnonzero(owner.scale > 0)
        node |= {"varies": varies, "centre": owner.centre[varies], "norm_scale": owner.scale[varies]}
    return node


def growth_numbers(growth: ErrorGrowth) -> Node:
    """An error-growth model at new commands, whose core is that of `train`."""
    negative = growth.core_exponent < 0
    return {
        "floor": np.where(negative, growth.core_exponent * np.log(growth.largest_core), 0.0),
        "slope": growth.slope.copy(),
        "bend": growth.bend.copy(),
        "steepest": growth.slope + 2 * growth.bend * growth.largest_log_distance,
        "reach": growth.largest_log_distance,
    }


#: What estimators of positions are in plain numbers, by the names of their classes.
POSITION_DESCRIBERS: dict[str, Callable[[Any, Samples, bool], Node]] = {
    "KinematicRegressor": of_one,
    "InSessions": of_one,
    "WeightedMean": of_mean,
    "MeanInSessions": of_mean,
}
