"""Specification of a target space: an entry of the registry."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class TargetSpace:
    """One target space: what a model is fitted to in place of positions in mm.

    `transformer(skip_constant, base)` returns an unfitted invertible transformer: `fit(positions, commands)`,
    `transform(positions)`, `inverse_transform(targets)`, `inverse_spread(targets, spread)`; positions (n_rows,
    n_coordinates) in mm, targets (n_rows, n_targets) standardised. `base` is what the dataset's entry declares of the
    robot's base.
    """

    name: str
    title: str
    transformer: Callable[[bool, Mapping[str, Any] | None], Any]
