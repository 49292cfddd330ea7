"""Registry of target spaces, what a model is fitted to: one file a space, one line here."""

from __future__ import annotations

from softkin.models.target_spaces import cartesian, curvature
from softkin.models.target_spaces.spec import TargetSpace

TARGET_SPACES: dict[str, TargetSpace] = {
    "cartesian": cartesian.SPACE,
    "curvature": curvature.SPACE,
}
