"""Target spaces: what a model is fitted to. One file a space, one line here."""

from __future__ import annotations

from softkin.interface import TargetSpace
from softkin.target_spaces import cartesian, curvature

TARGET_SPACES: dict[str, TargetSpace] = {
    "cartesian": cartesian.SPACE,
    "curvature": curvature.SPACE,
}
