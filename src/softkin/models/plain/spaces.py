"""Target spaces given as plain numbers, evaluated by numpy alone. Exported Python files hold a copy of this text."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from softkin.core.geometry.constant_curvature import from_arcs, spread_of_points
from softkin.models.plain.kernels import Node, Values


class Space(NamedTuple):
    """`positions` takes targets (n_rows, n_targets) to positions (n_rows, n_coordinates) in mm; `spread` takes targets
    and the spreads around them to spreads in mm.
    """

    positions: Callable[[Values], Values]
    spread: Callable[[Values, Values], Values]


def space(node: Node) -> Space:
    """The space that a node describes."""
    return SPACES[node["space"]](node)


def _scaled(node: Node) -> Space:
    """Targets times `scale` plus `mean` at the places `kept`; elsewhere `constants` (n_coordinates,)."""
    constants, kept, mean, scale = (node[name] for name in ("constants", "kept", "mean", "scale"))
    is_whole = len(kept) == len(constants)

    def positions(targets: Values) -> Values:
        if is_whole:
            return np.asarray(targets * scale + mean)
        result = constants[None].repeat(len(targets), axis=0)
        result[:, kept] = targets * scale + mean
        return np.asarray(result)

    def spread(_: Values, spreads: Values) -> Values:
        result = np.zeros((len(spreads), len(constants)))
        result[:, kept] = spreads * scale
        return result

    return Space(positions, spread)


def _arcs(node: Node) -> Space:
    """The first `n_arcs` targets are those of the space `arcs`: arcs of the markers `moving`, in the frame of the base
    with `origin` and `axes`; the others are those of the space `others`, of coordinates at the places `near_constant`.
    Elsewhere `constants` (n_markers, 3).
    """
    arcs, moving, constants, n_arcs = space(node["arcs"]), node["moving"], node["constants"], node["n_arcs"]
    origin, axes, near_constant = node["origin"], node["axes"], node["near_constant"]
    others = space(node["others"]) if "others" in node else None

    is_whole, is_upright = len(moving) == len(constants), np.array_equal(axes, np.eye(3)) and not origin.any()

    def positions(targets: Values) -> Values:
        bent = arcs.positions(targets[:, :n_arcs]).reshape(len(targets), -1, 3)
        points = from_arcs(bent) if is_upright else from_arcs(bent) @ axes.T + origin
        if not is_whole:
            moved, points = points, constants[None].repeat(len(targets), axis=0)
            points[:, moving] = moved
        result = points.reshape(len(targets), -1)
        if others is not None:
            result[:, near_constant] = others.positions(targets[:, n_arcs:])
        return np.asarray(result)

    def spread(targets: Values, spreads: Values) -> Values:
        points = np.zeros((len(targets), *constants.shape))
        bent = arcs.positions(targets[:, :n_arcs]).reshape(len(targets), -1, 3)
        of_bent = arcs.spread(targets[:, :n_arcs], spreads[:, :n_arcs]).reshape(bent.shape)
        points[:, moving] = spread_of_points(bent, of_bent, axes.T)
        result = points.reshape(len(targets), -1)
        if others is not None:
            result[:, near_constant] = others.spread(targets[:, n_arcs:], spreads[:, n_arcs:])
        return result

    return Space(positions, spread)


SPACES: dict[str, Callable[[Node], Space]] = {"scaled": _scaled, "arcs": _arcs}
