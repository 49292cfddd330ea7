"""Make recordings/: the simulated tendon finger with friction and backlash, as labs record it, in a file of each shape.

    python config/examples/make_recordings.py config/examples/recordings

Two motors wander, markers sit at each third of the length; 480 poses each, 0.4 mm of noise:

- two_files/: the controller's log and the export of a tracker (OptiTrack Motive), joined by time
- sessions.csv: switched on three times, each time with another zero
- lag.csv: the finger follows its motors with a time constant of 0.3 s
- gaps.csv: the tracker loses the tip for some frames
- swapped.csv: the tracker confuses the two upper markers now and then

`make benchmark-robots IN=config/examples/recordings` runs the workflow on all of them.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from softkin.core.samples import Array
from softkin.data.standins.tendon_finger import LARGEST_COUNT, bench_shapes

N_ROWS, RATE_HZ, NOISE_MM = 480, 20.0, 0.4
#: s: motors wander with this time constant; the finger that lags follows them with the other.
WANDERING, LAG = 0.6, 0.3
SESSIONS, ZERO_MM = 3, 2.0
#: Stretches of frames that the tip is lost in, and frames of each; rows in which the markers are confused.
LOST, STRETCH, CONFUSED = 4, 6, 12
MOTORS, MARKERS = ("motor1", "motor2"), ("low", "middle", "tip")
AXES = [f"{marker}_{axis}_mm" for marker in MARKERS for axis in "xyz"]


def filtered(values: Array, seconds: float) -> Array:
    """A first-order low-pass filter along rows."""
    kept = np.exp(-1 / (RATE_HZ * seconds))
    return np.asarray(lfilter([1 - kept], [1, -kept], values, axis=0))


def commands_of(rng: np.random.Generator) -> Array:
    """Motor counts (n_rows, 2) that wander within their largest."""
    walk = filtered(rng.standard_normal((N_ROWS, 2)), WANDERING)
    return LARGEST_COUNT * np.tanh(walk / walk.std()) / np.sqrt(2)


def poses_of(counts: Array, rng: np.random.Generator) -> Array:
    """Positions (n_rows, 9) in mm of the markers, in the order of the commands."""
    nodes = bench_shapes(counts).positions
    markers = nodes[:, [nodes.shape[1] // 3, 2 * nodes.shape[1] // 3, -1]].reshape(len(counts), -1)
    return markers + NOISE_MM * rng.standard_normal(markers.shape)


def write(path: Path, header: list[str], columns: Array, lost: np.ndarray | None = None) -> None:
    """A table as CSV; the last three cells of the rows `lost` are empty."""
    lines = [",".join(header)]
    for row, values in enumerate(columns):
        cells = [f"{value:.3f}".removesuffix(".000") for value in values]
        if lost is not None and lost[row]:
            cells[-3:] = ["", "", ""]
        lines.append(",".join(cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_take(path: Path, positions: Array) -> None:
    """Positions as Motive exports them, in metres."""
    names = [f"finger:{marker}" for marker in MARKERS for _ in "xyz"]
    header = [
        f"Format Version,1.23,Take Name,take,Export Frame Rate,{RATE_HZ:.6f},Rotation Type,Quaternion,"
        "Length Units,Meters,Coordinate Space,Global",
        "",
        ",".join(["", "Type", *["Marker"] * len(AXES)]),
        ",".join(["", "Name", *names]),
        ",".join(["", "ID", *names]),
        ",".join(["", "", *["Position"] * len(AXES)]),
        ",".join(["Frame", "Time (Seconds)", *"XYZ" * len(MARKERS)]),
    ]
    rows = [
        f"{row},{row / RATE_HZ:.6f}," + ",".join(f"{value / 1000:.6f}" for value in pose)
        for row, pose in enumerate(positions)
    ]
    path.write_text("\n".join([*header, *rows]) + "\n", encoding="utf-8")


def main(folder: Path) -> None:
    """Write all recordings into the folder."""
    (folder / "two_files").mkdir(parents=True, exist_ok=True)
    # A generator for each file, so that one can change without the others.
    two, sessions, lag, gaps, swapped = (np.random.default_rng(seed) for seed in range(5))
    time = np.arange(N_ROWS)[:, None] / RATE_HZ

    commands = commands_of(two)
    ticks = time + two.uniform(0, 0.1 / RATE_HZ, (N_ROWS, 1))
    write(folder / "two_files" / "commands.csv", ["time_s", *MOTORS], np.hstack([ticks, commands]))
    write_take(folder / "two_files" / "take.csv", poses_of(commands, two))

    commands = commands_of(sessions)
    session = np.repeat(np.arange(SESSIONS), N_ROWS // SESSIONS)
    parts = [poses_of(part, sessions) for part in np.split(commands, SESSIONS)]
    zeros = np.tile(ZERO_MM * sessions.standard_normal((SESSIONS, 3)), len(MARKERS))[session]
    table = np.hstack([session[:, None] + 1, time, commands, np.vstack(parts) + zeros])
    write(folder / "sessions.csv", ["session", "time_s", *MOTORS, *AXES], table)

    commands = commands_of(lag)
    table = np.hstack([time, commands, poses_of(filtered(commands, LAG), lag)])
    write(folder / "lag.csv", ["time_s", *MOTORS, *AXES], table)

    commands = commands_of(gaps)
    lost = np.zeros(N_ROWS, dtype=bool)
    for start in gaps.choice(N_ROWS - STRETCH, LOST, replace=False):
        lost[start : start + STRETCH] = True
    write(folder / "gaps.csv", ["time_s", *MOTORS, *AXES], np.hstack([time, commands, poses_of(commands, gaps)]), lost)

    commands = commands_of(swapped)
    poses = poses_of(commands, swapped)
    confused = swapped.choice(N_ROWS, CONFUSED, replace=False)
    poses[confused] = poses[confused][:, [0, 1, 2, 6, 7, 8, 3, 4, 5]]
    write(folder / "swapped.csv", ["time_s", *MOTORS, *AXES], np.hstack([time, commands, poses]))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
