"""Registry of joint regions, which hold all moving coordinates at once: one file a shape, one line here."""

from __future__ import annotations

from softkin.uncertainty.regions import balls, bonferroni, box, ellipsoids
from softkin.uncertainty.regions.spec import RegionMethod

REGION_METHODS: dict[str, RegionMethod] = {
    "joint_bonferroni": bonferroni.METHOD,
    "joint_box": box.METHOD,
    "joint_balls": balls.METHOD,
    "joint_scaled_balls": balls.SCALED,
    "joint_ellipsoids": ellipsoids.METHOD,
}
