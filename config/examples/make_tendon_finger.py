"""Make tendon_finger.csv: the simulated tendon finger with friction, backlash and noise, as a lab would record it.

    python config/examples/make_tendon_finger.py > config/examples/tendon_finger.csv

Motor counts, and the tip in mm; 600 rows in the order in which the commands were sent.
"""

from __future__ import annotations

import sys

import numpy as np

from softkin.data.standins import STANDINS

N_ROWS = 600

finger = STANDINS["tendon_finger_frictional"]
drawing, measuring = np.random.default_rng(0).spawn(2)
commands = finger.draw(N_ROWS, drawing)
table = np.hstack([commands, finger.poses(commands, measuring)])
np.savetxt(sys.stdout, table, "%.3f", ",", header="motor1,motor2,tip_x_mm,tip_y_mm,tip_z_mm", comments="")
