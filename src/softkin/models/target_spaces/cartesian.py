"""Cartesian target space: standardised positions, as in the paper."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from softkin.models.estimators.position_scaler import PositionScaler
from softkin.models.target_spaces.spec import TargetSpace


def transformer(skip_constant: bool, base: Mapping[str, Any] | None) -> PositionScaler:
    """Unfitted transformer of positions to standardised positions."""
    return PositionScaler(skip_constant)


SPACE = TargetSpace("cartesian", "Cartesian", transformer)
