"""Make oriented_finger.csv: the simulated tendon finger with friction, backlash and noise, and where its tip points.

    python config/examples/make_oriented_finger.py > config/examples/oriented_finger.csv

Motor counts, the tip in mm, and its orientation as a quaternion with 0.3 degrees of noise about each axis; 400 rows in
the order in which the commands were sent.
"""

from __future__ import annotations

import sys

import numpy as np
from scipy.spatial.transform import Rotation

from softkin.data.standins import STANDINS
from softkin.data.standins.tendon_finger import NOISE_MM, bench_shapes

N_ROWS = 400
NOISE_DEGREES = 0.3

drawing, measuring = np.random.default_rng(0).spawn(2)
commands = STANDINS["tendon_finger_frictional"].draw(N_ROWS, drawing)
shapes = bench_shapes(commands)
tips = shapes.positions[:, -1] + NOISE_MM * measuring.standard_normal((N_ROWS, 3))
noise = Rotation.from_rotvec(NOISE_DEGREES * measuring.standard_normal((N_ROWS, 3)), degrees=True)
turned = Rotation.from_quat(shapes.quaternions[:, -1], scalar_first=True) * noise
table = np.hstack([commands, tips, turned.as_quat(canonical=True)])
header = "motor1,motor2,tip_x_mm,tip_y_mm,tip_z_mm,tip_qx,tip_qy,tip_qz,tip_qw"
np.savetxt(sys.stdout, table, ["%.3f"] * 5 + ["%.5f"] * 4, ",", header=header, comments="")
