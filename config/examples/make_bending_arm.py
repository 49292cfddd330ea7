"""Make bending_arm.csv: a soft arm of three chambers that bends as constant-curvature arcs; markers at middle and tip.

    python config/examples/make_bending_arm.py > config/examples/bending_arm.csv

Pressures in bar, positions in mm with 0.2 mm of noise. Source: Webster and Jones (2010), Design and kinematic modeling
of constant curvature continuum robots: a review.
"""

from __future__ import annotations

import sys

import numpy as np

N_ROWS = 600
LENGTH_MM = 200.0
RADIANS_PER_BAR = 0.9
NOISE_MM = 0.2

rng = np.random.default_rng(0)
pressures = rng.uniform(0.0, 1.5, (N_ROWS, 3)).round(4)
chambers = 2 * np.pi * np.arange(3) / 3
bend_x, bend_y = RADIANS_PER_BAR * pressures @ np.cos(chambers), RADIANS_PER_BAR * pressures @ np.sin(chambers)
markers = []
for share in (0.5, 1.0):
    angle = share * np.hypot(bend_x, bend_y)
    length = share * LENGTH_MM
    direction = np.arctan2(bend_y, bend_x)
    # sinc(a / 2 pi) sin(a / 2) = (1 - cos a) / a without dividing by zero; np.sinc holds the pi.
    out = length * np.sinc(angle / (2 * np.pi)) * np.sin(angle / 2)
    up = length * np.sinc(angle / np.pi)
    markers += [out * np.cos(direction), out * np.sin(direction), up]
positions = np.column_stack(markers) + NOISE_MM * rng.standard_normal((N_ROWS, 6))

header = "p1_bar,p2_bar,p3_bar,middle_x,middle_y,middle_z,tip_x,tip_y,tip_z"
np.savetxt(sys.stdout, np.hstack([pressures, positions]), "%.4f", ",", header=header, comments="")
