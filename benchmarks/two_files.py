"""Measure the way from a tracker's export and a log of commands to a calibrated model: two commands in five minutes?

    python -m benchmarks.two_files [--rows 60000] [--cores 2] [--keep FOLDER] [--all]

Makes up an arm of three markers that lags behind its commands, as OptiTrack Motive would export it at 120 Hz, some
markers lost for stretches of frames, and the log of a controller whose clock ticks unevenly. Then it does what `make
new-robot FILE=commands.csv POSITIONS=take.csv WRITE=1` and `make run ROBOT=commands MORE=config/few_trials.yaml` do, up
to the calibrated model; with `--all` up to the report. No file is edited between the two. Prints wall and CPU seconds
and the largest memory of each, and the CPU seconds of each job. The exit status is 1 where both take longer than
`--minutes`, or one fails.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.measured_run import HOUSE, measured_run, snakemake
from benchmarks.utilisation import jobs
from softkin.core.geometry.constant_curvature import from_arcs
from softkin.core.samples import Array

RATE_HZ = 120.0
LENGTHS_MM = (70.0, 140.0, 200.0)
NOISE_MM = 0.15
#: s: the arm follows its commands with this time constant, and commands wander with the other.
LAG, WANDERING = 0.05, 2.0
#: Share of the frames in which the last marker is lost, in stretches of this many.
LOST, STRETCH = 0.01, 20
FEW_TRIALS = "config/few_trials.yaml"


def recording(n_rows: int) -> tuple[Array, Array]:
    """Commands (n_rows, 3) in [-1, 1] at 120 Hz, and positions in mm (n_rows, 9) of the markers that follow them."""
    rng = np.random.default_rng(0)
    commands = np.tanh(1.2 * _low_passed(rng.standard_normal((n_rows, 3)), WANDERING))
    followed = _low_passed(commands, LAG, scaled=False)
    bending = np.column_stack([followed[:, 0] + 0.3 * followed[:, 2], followed[:, 1] - 0.2 * followed[:, 2]])
    whole = np.column_stack([np.tanh(bending), LENGTHS_MM[-1] * (1 + 0.05 * followed[:, 2])])
    arcs = np.stack([whole * length / LENGTHS_MM[-1] for length in LENGTHS_MM], axis=1)
    positions = from_arcs(arcs).reshape(n_rows, -1)
    return commands, positions + NOISE_MM * rng.standard_normal(positions.shape)


def _low_passed(values: Array, seconds: float, scaled: bool = True) -> Array:
    """A first-order low-pass filter along rows at 120 Hz; `scaled` to variance 1."""
    from scipy.signal import lfilter

    kept = np.exp(-1 / (RATE_HZ * seconds))
    filtered = np.asarray(lfilter([1 - kept], [1, -kept], values, axis=0))
    return filtered / filtered.std(axis=0) if scaled else filtered


def write_take(path: Path, positions: Array) -> None:
    """The positions as Motive exports them, cells of the last marker empty where it was lost."""
    n_rows, n_markers = len(positions), len(LENGTHS_MM)
    starts = np.random.default_rng(1).choice(n_rows - STRETCH, int(LOST * n_rows / STRETCH), replace=False)
    lost = {row for start in starts.tolist() for row in range(start, start + STRETCH)}
    names = [f"arm:Marker{marker + 1}" for marker in range(n_markers) for _ in "xyz"]
    header = [
        f"Format Version,1.23,Take Name,take,Export Frame Rate,{RATE_HZ:.6f},Rotation Type,Quaternion,"
        "Length Units,Millimeters,Coordinate Space,Global",
        "",
        ",".join(["", "Type", *["Marker"] * 3 * n_markers]),
        ",".join(["", "Name", *names]),
        ",".join(["", "ID", *names]),
        ",".join(["", "", *["Position"] * 3 * n_markers]),
        ",".join(["Frame", "Time (Seconds)", *"XYZ" * n_markers]),
    ]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(header) + "\n")
        for row, pose in enumerate(positions):
            cells = [f"{value:.6f}" for value in pose]
            if row in lost:
                cells[-3:] = ["", "", ""]
            file.write(f"{row},{row / RATE_HZ:.6f},{','.join(cells)}\n")


def write_log(path: Path, commands: Array) -> None:
    """The log of the controller: its ticks are late by up to a tenth of a step."""
    late = np.random.default_rng(2).uniform(0.0, 0.1 / RATE_HZ, len(commands))
    with open(path, "w", encoding="utf-8") as file:
        file.write("time_s;p1_bar;p2_bar;p3_bar\n")
        for time_s, row in zip(np.arange(len(commands)) / RATE_HZ + late, commands, strict=True):
            file.write(f"{time_s:.5f};{';'.join(f'{value:.5f}' for value in row)}\n")


def measure(folder: Path, options: argparse.Namespace) -> bool:
    """Write the two files and do the two commands in `folder`; whether they stayed within the limit."""
    shutil.copytree(HOUSE / "config", folder / "config")
    commands, positions = recording(options.rows)
    write_log(folder / "commands.csv", commands)
    write_take(folder / "take.csv", positions)
    target = [] if options.all else ["results/commands/calibrated_model.joblib"]
    steps = {
        "new-robot": [sys.executable, "-m", "softkin.cli.new_robot", "--write", "--", "commands.csv", "take.csv"],
        "run": snakemake(
            folder,
            *(*target, "--cores", str(options.cores), "--quiet", "rules"),
            *("--config", "datasets=[commands]", "--configfile", "config/datasets.yaml", FEW_TRIALS),
        ),
    }
    seconds = 0.0
    for name, command in steps.items():
        run = measured_run(command, folder=folder)
        seconds += run.wall
        print(f"{name}: {run.wall:.0f} s, {run.cpu:.0f} s of CPU, {run.gigabytes:.2f} GB at most, status {run.status}")
        if run.status:
            return False
    table = jobs(folder / "results")[["job", "cpu_s", "fit_cpu_s", "memory_mb"]]
    print(f"{table['cpu_s'].sum():.0f} s of CPU by the clocks of the jobs:")
    print(table.sort_values("cpu_s", ascending=False).round(1).to_string(index=False))
    print(f"{options.rows} rows, both: {seconds / 60:.1f} minutes", flush=True)
    return bool(seconds <= 60 * options.minutes)


def main() -> int:
    """Measure; the exit status is 1 beyond the limit."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rows", type=int, default=60_000)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--minutes", type=float, default=5.0, help="wall time of both commands together at most")
    parser.add_argument("--keep", type=Path, help="work in this new folder and leave it")
    parser.add_argument("--all", action="store_true", help="up to the report and the store")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.keep or Path(temporary) / "project").resolve()
        folder.mkdir(parents=True)
        return int(not measure(folder, options))


if __name__ == "__main__":
    sys.exit(main())
