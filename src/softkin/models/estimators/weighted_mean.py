"""The weighted mean of fitted regressors of positions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from softkin.core.samples import Array
from softkin.models.estimators.in_sessions import InSessions


class WeightedMean:
    """`members` are fitted and predict positions (n_rows, n_coordinates) in mm; `weights` are as many, none negative,
    and add up to 1; `names` are what people call them.
    """

    def __init__(self, members: Sequence[Any], weights: Sequence[float], names: Sequence[str]) -> None:
        self.members = members
        self.weights = weights
        self.names = names

    def predict(self, X: Array) -> Array:
        """Positions (n_rows, n_coordinates) in mm at commands, or inputs of a recording, X."""
        return weighted_sum([member.predict(X) for member in self.members], self.weights)


class MeanInSessions(InSessions):
    """The same of members that know one recording: its memory and sessions, each session with the mean of their zeros.

    Each member is told of earlier commands what it was fitted with.
    """

    def __init__(self, members: Sequence[Any], weights: Sequence[float], names: Sequence[str]) -> None:
        super().__init__(None, members[0].robot, zeros=any(member.zeros for member in members))
        self.members = members
        self.weights = weights
        self.names = names
        # Members that are fitted on some of the rows may lack a short session, which then adds no zero to theirs.
        self.features_ = members[0].features_
        self.sessions_ = np.unique(np.concatenate([member.sessions_ for member in members]))
        self.zeros_ = weighted_sum([member.zeros_of(self.sessions_) for member in members], weights)

    def predict(self, X: Array) -> Array:
        """Positions (n_rows, n_coordinates) in mm at inputs, or at bare commands."""
        inputs = self.inputs(X)
        return weighted_sum([member.predict(inputs) for member in self.members], self.weights)


def weighted_mean(members: Sequence[Any], weights: Sequence[float], names: Sequence[str]) -> Any:
    """The fitted regressor of these fitted members; a member alone is that itself."""
    if len(members) == 1:
        return members[0]
    kind = MeanInSessions if isinstance(members[0], InSessions) else WeightedMean
    return kind(members, weights, names)


def composition(estimator: Any) -> str:
    """' of 75 % gp outer, 25 % lr tuned', the largest weight first; empty where the regressor is no mean."""
    if not isinstance(estimator, (WeightedMean, MeanInSessions)):
        return ""
    ordered = sorted(zip(estimator.weights, estimator.names, strict=True), key=lambda member: -member[0])
    return " of " + ", ".join(f"{weight:.0%} {name}".replace("%", " %") for weight, name in ordered)


def weighted_sum(arrays: Sequence[Array], weights: Sequence[float]) -> Array:
    """The sum of arrays of one shape, each times its weight, in their order; one alone is that itself."""
    if len(arrays) == 1:
        return arrays[0]
    total = np.zeros_like(arrays[0])
    for array, weight in zip(arrays, weights, strict=True):
        total = total + weight * array
    return total
