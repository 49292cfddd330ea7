"""Commands for targets: softkin's bounded search beside the damped least squares of the dataset's authors.

python -m benchmarks.inverse [MIRROR]: on stand-ins, which can be sent the commands; with a folder that holds
FINGER.json and ABAQUS.json on these, too, targets being held-out positions of `validation`, as `test` is left alone.

The authors invert their network by damped least squares, from the middle of the commands, for up to 2,000 iterations,
without bounds. Their code is not at hand, and their damping is not known: three are tried, of which the table shows the
one of the smallest median residual. It ends early where the residual is below the limit at which softkin's search ends;
`stalls` also ends it where a step moves no command by more than 1e-9 of its range, which is kinder than described. Both
invert the same Gaussian process, whose derivatives both take by the same finite differences of one call. The two take
turns; of softkin's times, of five calls at each turn, the median counts.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from scipy.stats import binom

from softkin.core.samples import TEST, TRAIN, VALIDATION, Array, Samples
from softkin.data.prepare import prepare
from softkin.data.standins import STANDINS
from softkin.data.standins.simulating import simulate
from softkin.data.table import read_subset
from softkin.models import MODELS
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.intervals import INTERVAL_METHODS

HOUSE = Path(__file__).parents[1]
GP = {"kernel": "rbf", "trend": "linear", "max_iter": 10, "learning_rows": 200}
N_TRAIN, N_VALIDATION, N_TIMED, N_SENT, LEVEL = 600, 200, 200, 200, 0.9
N_CALLS = 5
ITERATIONS, STEP, STALLED, DAMPINGS = 2_000, 1e-6, 1e-9, (1e-3, 1e-2, 1e-1)
#: No seed of a configuration, a test or another benchmark.
SEED = 2101


def main() -> None:
    """Print a line for each robot and scheme, and one for each stand-in that was sent the commands."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mirror", nargs="?", type=Path, help="folder with FINGER.json and ABAQUS.json")
    asked = parser.parse_args()
    print(f"{'robot':<26} {'scheme':<28} {'ms a target':>11} {'median residual mm':>19} {'largest':>10} {'beyond':>7}")
    for name, robot, targets in robots(asked.mirror):
        for line in compared(robot, targets[:N_TIMED]):
            print(f"{name:<26} {line}", flush=True)
        if name in STANDINS:
            print(f"{name:<26} {sent(name, robot, targets)}", flush=True)


def robots(mirror: Path | None) -> Iterator[tuple[str, CalibratedModel, Array]]:
    """Names, robots, and positions (n_targets, 3) of the last marker that they were not fitted to."""
    for name in ("tendon_finger", "tendon_finger_frictional", "pneumatic_arm"):
        sizes = {TRAIN: N_TRAIN, VALIDATION: N_VALIDATION, TEST: N_SENT, "extrapolation": 100}
        subsets = simulate(name, n_rows=sizes, seed=SEED)
        yield name, gaussian_process(name, subsets[TRAIN], subsets[VALIDATION]), subsets[TEST].positions[:, -3:]
    for name in ("finger", "abaqus") if mirror is not None else ():
        assert mirror is not None
        train, validation = published(mirror, name)
        yield name, gaussian_process(name, train, validation), validation.positions[:, -3:]


def published(mirror: Path, name: str) -> list[Samples]:
    """`train`, of which some rows, and `validation` of a published robot."""
    source = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"][name]
    with tempfile.TemporaryDirectory() as folder:
        table, about = Path(folder) / "table.parquet", Path(folder) / "about.json"
        prepare(mirror / source["file"], dataset=name, source=source, table=table, description=about)
        subsets = [read_subset(table, subset) for subset in (TRAIN, VALIDATION)]
    rows = [np.random.default_rng(SEED).permutation(len(subset)) for subset in subsets]
    return [subset.take(row[:N_TRAIN]) for subset, row in zip(subsets, rows, strict=True)]


def gaussian_process(name: str, train: Samples, validation: Samples) -> CalibratedModel:
    """A robot with split conformal intervals."""
    fit = FitSettings(GP, skip_constant=True, seed=0, threads=1)
    model = FittedModel(name, MODELS["gp"], "tuned", fitted_model(MODELS["gp"], fit, train), train)
    return calibrated(model, INTERVAL_METHODS["scp_crepes"], validation)


def compared(robot: CalibratedModel, targets: Array) -> Iterator[str]:
    """A line for each scheme: CPU time, residuals, and the share of commands beyond the bounds of `train`."""
    errors = np.linalg.norm((robot.known.truth - robot.known.calibration)[:, -3:], axis=1)
    reach = float(np.linalg.norm(np.ptp(np.asarray(robot.predict(robot.train.commands))[:, -3:], axis=0)))
    close = max(0.01 * float(np.median(errors)), 1e-6 * reach)
    robot.command_for(targets[:1])
    lines, own = [], []
    for stalls in (False, True):
        tried = []
        for damping in DAMPINGS:
            for _ in range(N_CALLS):
                began = time.process_time()
                found: Any = robot.command_for(targets)
                own.append(time.process_time() - began)
            began = time.process_time()
            commands = np.array([damped(robot, target, damping, close, stalls=stalls) for target in targets])
            taken = time.process_time() - began
            tried.append((float(np.median(residuals(robot, targets, commands))), damping, commands, taken))
        _, damping, commands, taken = min(tried, key=lambda one: one[0])
        scheme = f"damped {damping:g}{', stalls' if stalls else ''}"
        lines.append(line(scheme, robot, targets, commands, taken))
    began = time.process_time()
    each = np.vstack([np.asarray(robot.command_for(target).commands) for target in targets])
    one_by_one = time.process_time() - began
    yield line("softkin", robot, targets, found.commands, float(np.median(own)))
    yield line("softkin, one by one", robot, targets, each, one_by_one)
    yield from lines


def damped(robot: CalibratedModel, target: Array, damping: float, close: float, *, stalls: bool) -> Array:
    """The command (n_commands,) by damped least squares: steps J' inverse(J J' + (damping s)^2 1) times what is
    missing, of the Jacobian J in units of each command's range, and its largest singular value s at the start.
    """
    lower, upper = robot.train.commands.min(axis=0), robot.train.commands.max(axis=0)
    share, largest = np.full(len(lower), 0.5), 0.0
    for _ in range(ITERATIONS):
        rows = np.vstack([share, share + STEP * np.eye(len(share))])
        points = robot._prepared.predicted_of_few(lower + rows * (upper - lower))[:, -3:]
        missing, jacobian = target - points[0], ((points[1:] - points[0]) / STEP).T
        if np.linalg.norm(missing) <= close:
            break
        largest = largest or float(np.linalg.svd(jacobian, compute_uv=False)[0])
        step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + (damping * largest) ** 2 * np.eye(3), missing)
        share = np.clip(share + step, -1e3, 1e3)  # a model may send a command to infinity, where numbers end
        if stalls and np.abs(step).max() <= STALLED:
            break
    return np.asarray(lower + share * (upper - lower))


def residuals(robot: CalibratedModel, targets: Array, commands: Array) -> Array:
    """How far (n_targets,) in mm predicted positions are from targets."""
    return np.asarray(np.linalg.norm(np.asarray(robot.predict(commands))[:, -3:] - targets, axis=1))


def line(scheme: str, robot: CalibratedModel, targets: Array, commands: Array, taken: float) -> str:
    """A line of the table."""
    far = residuals(robot, targets, commands)
    lower, upper = robot.train.commands.min(axis=0), robot.train.commands.max(axis=0)
    beyond = ((commands < lower - 1e-9 * (upper - lower)) | (commands > upper + 1e-9 * (upper - lower))).any(axis=1)
    milliseconds = 1e3 * taken / len(targets)
    return f"{scheme:<28} {milliseconds:>11.3g} {np.median(far):>19.3g} {far.max():>10.3g} {beyond.mean():>7.1%}"


def sent(name: str, robot: CalibratedModel, targets: Array) -> str:
    """The commands are sent to the stand-in, one after the other: how often it is as near as promised."""
    found: Any = robot.command_for(targets, confidence=LEVEL)
    reached = STANDINS[name].poses(found.commands, np.random.default_rng(SEED + 1))[:, -3:]
    held = int((np.linalg.norm(reached - targets, axis=1) <= found.within_mm).sum())
    fewest = int(binom.ppf(0.005, len(targets), LEVEL))
    verdicts = ", ".join(f"{(found.verdict == word).sum()} {word}" for word in ("reachable", "nearest", "outside"))
    return (
        f"sent {len(targets)} commands: {held} within what was promised at {LEVEL:.0%} (median "
        f"{np.median(found.within_mm):.3g} mm); at least {fewest} are to be expected; {verdicts}"
    )


if __name__ == "__main__":
    main()
