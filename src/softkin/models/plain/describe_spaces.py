"""Registry of what fitted target spaces are in plain numbers: one line for each class, read by its name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from softkin.core.errors import ConfigError
from softkin.models.plain.kernels import Node


def described_space(transformer: Any) -> Node:
    """The node of a fitted transformer of positions.

    Raises:
        ConfigError: there is no describer for its class.
    """
    name = type(transformer).__name__
    if name not in SPACE_DESCRIBERS:
        raise ConfigError(
            f"a target space {name} cannot be written as plain numbers",
            where=name,
            fix=f"use a model in one of these: {', '.join(SPACE_DESCRIBERS)}",
        )
    return SPACE_DESCRIBERS[name](transformer)


def of_positions(transformer: Any) -> Node:
    """Of a PositionScaler."""
    scaler = transformer.scaler_
    kept = np.flatnonzero(transformer.kept_)
    return {
        "space": "scaled",
        "constants": np.asarray(transformer.constants_, dtype=np.float64),
        "kept": kept,
        "mean": scaler.mean_,
        "scale": scaler.scale_,
    }


def of_curvature(transformer: Any) -> Node:
    """Of CurvatureCoordinates."""
    near_constant = np.flatnonzero(transformer.near_constant_)
    node: Node = {
        "space": "arcs",
        "arcs": of_positions(transformer.scaler_),
        "n_arcs": transformer.n_arcs_,
        "moving": np.flatnonzero(transformer.moving_),
        "constants": transformer.constants_,
        "origin": np.asarray(transformer.frame_.origin, dtype=np.float64),
        "axes": transformer.frame_.axes(),
        "near_constant": near_constant,
    }
    if transformer.near_constant_scaler_ is not None:
        scaler = transformer.near_constant_scaler_
        everywhere = np.arange(len(near_constant))
        zeros = np.zeros(len(near_constant))
        others = {"space": "scaled", "constants": zeros, "kept": everywhere, "mean": scaler.mean_}
        node["others"] = others | {"scale": scaler.scale_}
    return node


SPACE_DESCRIBERS: dict[str, Callable[[Any], Node]] = {
    "PositionScaler": of_positions,
    "CurvatureCoordinates": of_curvature,
}
