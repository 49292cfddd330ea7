"""What an answer costs: one command with a 90 % interval, many, loading, memory; of a model and of its exports.

    python -m benchmarks.latency [results/finger/calibrated_model.joblib ...] [--environment]

Beside a polynomial and a Gaussian process on a made-up arm of 1,000 rows of `train`, with shells, the models that are
given. One command at a time, in process, on one thread (OMP_NUM_THREADS=1), in CPU time. `bare` is the estimator's
`predict` alone, `numpy` the same position written by hand. Exports are compared with the model on 10,000 commands,
inside and outside; with --environment the Python file also runs in a new environment that holds numpy alone. The bare
estimator and the model take turns at many commands.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import subprocess
import sys
import tempfile
import time
import venv
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import joblib
import numpy as np

from softkin.core.samples import Array, Params, Samples
from softkin.core.shells import command_norm
from softkin.models import MODELS
from softkin.models.estimators.kinematic_regressor import KinematicRegressor
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.calibration_data import Shell
from softkin.uncertainty.export.c_header import c_header
from softkin.uncertainty.export.python_file import python_file
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.loading import load
from tests.compiled_header import asked, compiled

N_TRAIN, N_VALIDATION, N_CALLS, N_MANY, N_COMPARED, LEVEL = 1000, 300, 300, 100_000, 10_000, 0.9
#: What takes more ms is asked in one round of fewer calls; many rows in at most so many turns and CPU seconds.
SLOW_MS, N_SLOW, TURNS, TURNS_S = 5.0, 100, 5, 10.0
Rows = Iterator[dict[str, Any]]
LOADED = """
import json, sys, time
{load}
{ask}
largest = next(line for line in open('/proc/self/status') if line.startswith('VmHWM'))
print(json.dumps([1e3 * time.process_time(), int(largest.split()[1]) / 1024]))
"""


def main() -> None:
    """Print a line for each model and way to ask it, then how exports agree."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", help="calibrated_model.joblib")
    parser.add_argument("--rows", type=int, default=N_MANY, help="rows that are asked for at once")
    parser.add_argument("--environment", action="store_true", help="run Python files where there is numpy alone")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        python = numpy_alone(Path(folder)) if arguments.environment else None
        for robot in chain(made_up(), (load(path, trust=True) for path in arguments.models)):
            with tempfile.TemporaryDirectory() as there:
                program = compiled(c_header(robot, [LEVEL], name="arm"), "arm", Path(there), "-O2")
                of_robot = Path(there), program
                for row in chain(latencies(robot, arguments.rows, *of_robot), agreement(robot, *of_robot, python)):
                    print(json.dumps(row), flush=True)


def title(robot: CalibratedModel) -> str:
    """Robot, model, method."""
    return f"{robot.dataset}, {robot.spec.name}, {robot.method.name}"


def latencies(robot: CalibratedModel, n_rows: int, there: Path, program: Path) -> Rows:
    """A row for each way to ask and place: median and p99 in ms, of many rows in all; load time and memory. A folder
    `there` holds the compiled `program`.
    """
    own = {"robot": title(robot)}
    ways = {"model": robot, "Python file": exported(robot, there)}
    joblib.dump(robot, there / "model.joblib")
    joblib.dump(robot.estimator, there / "bare.joblib")
    for where, commands in places(robot).items():
        calls: dict[str, Callable[[Array], object]] = {
            "bare estimator": lambda row: robot.estimator.predict(row[None]),
            "model": partial(robot.intervals, confidence_levels=LEVEL),
            "Python file": partial(ways["Python file"].intervals, level=LEVEL),
        }
        if (hand := by_hand(robot)) is not None:
            calls["numpy by hand"] = hand
        if where == "streaming":
            loop, state = ways["Python file"].start(level=LEVEL), robot.start(confidence_level=LEVEL)
            calls = {"model": state.step, "Python file": loop.step}
        for way, call in calls.items():
            yield own | {"way": way, "where": where} | quantiles(call, commands)
        if where != "streaming":
            yield own | {"way": "C header", "where": where} | of_program(program, commands, robot)
    several = np.resize(robot.train.commands, (n_rows, robot.train.commands.shape[1]))
    bare, whole = in_turns(robot.estimator.predict, at_level(robot), several)
    yield own | {"way": "model", "where": "many rows", "rows": n_rows, "ms": whole, "bare_ms": bare}
    yield from (own | row for row in loading(robot.train.commands[0].tolist(), there))
    for way, path in {"model": "model.joblib", "Python file": "arm_file.py", "C header": "arm"}.items():
        yield own | {"way": way, "where": "size", "kb": (there / path).stat().st_size / 1024}


def loading(row: list[float], there: Path) -> Rows:
    """What a new process takes until its first answer, to the command `row`, and its size."""
    asks = {
        "bare estimator": (
            "import joblib, numpy; m = joblib.load('bare.joblib')",
            f"m.predict(numpy.array([{row}]))",
        ),
        "model": ("import softkin; m = softkin.load('model.joblib', trust=True)", f"m.intervals({row}, {LEVEL})"),
        "Python file": ("sys.path.append('.')\nfrom arm_file import model", f"model.intervals({row}, {LEVEL})"),
    }
    for way, (of_load, ask) in asks.items():
        done = subprocess.run(
            [sys.executable, "-c", LOADED.format(load=of_load, ask=ask)], cwd=there, capture_output=True, check=True
        )
        taken, megabytes = json.loads(done.stdout)
        yield {"way": way, "where": "load and answer", "ms": taken, "mb": megabytes}


def agreement(robot: CalibratedModel, folder: Path, program: Path, python: Path | None) -> Rows:
    """How far, at most, exports are from the model on `N_COMPARED` commands, in mm; and one row from many. `python`
    is that of an environment with numpy alone.
    """
    low, high = robot.train.commands.min(axis=0), robot.train.commands.max(axis=0)
    span = high - low
    commands = np.random.default_rng(0).uniform(low - 0.2 * span, high + 0.2 * span, (N_COMPARED, len(low)))
    said, bounds = np.asarray(robot.predict(commands)), np.asarray(robot.intervals(commands, LEVEL))
    outside = np.asarray(robot.is_outside(commands))

    def compared(way: str, answers: tuple[Array, Array, Array]) -> dict[str, Any]:
        off = [float(np.abs(one - other).max()) for one, other in zip(answers[:2], (said, bounds), strict=True)]
        differ = int((np.asarray(answers[2]) != outside).sum())
        return {"robot": title(robot), "way": way, "where": "difference", "mm": max(off), "outside_differs": differ}

    model = exported(robot, folder)
    yield compared(
        "Python file", (model.predict(commands), model.intervals(commands, LEVEL), model.is_outside(commands))
    )
    c = asked(program, commands, said.shape[1], level=LEVEL, failures=robot.failures is not None)
    yield compared("C header", (c.position, np.stack([c.lower, c.upper], axis=-1), c.outside))
    one = [np.asarray(robot.intervals(row, LEVEL))[0] for row in commands[:N_CALLS]]
    of_c = np.stack([c.lower, c.upper], axis=-1)[:N_CALLS]
    against = {"model, one row against many": bounds[:N_CALLS], "C header against the model's one row": of_c}
    for way, other in against.items():
        off = float(np.abs(np.stack(one) - other).max())
        yield {"robot": title(robot), "way": way, "where": "difference", "mm": off}
    if python is not None:
        yield compared("Python file, numpy alone", in_new_environment(python, folder, commands))


def numpy_alone(folder: Path) -> Path:
    """The Python of a new virtual environment that has numpy alone."""
    venv.create(folder / "venv", with_pip=True)
    python = folder / "venv" / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", f"numpy=={np.__version__}"], check=True)
    return python


def in_new_environment(python: Path, folder: Path, commands: Array) -> tuple[Array, Array, Array]:
    """What the Python file in a folder answers by another `python`."""
    np.save(folder / "commands.npy", commands)
    code = "import numpy as np\nfrom arm_file import model\nx = np.load('commands.npy')\n"
    code += f"np.savez('said.npz', a=model.predict(x), b=model.intervals(x, {LEVEL}), c=model.is_outside(x))"
    subprocess.run([python, "-c", code], cwd=folder, check=True, env={})
    said = np.load(folder / "said.npz")
    return said["a"], said["b"], said["c"]


def exported(robot: CalibratedModel, folder: Path) -> Any:
    """The model of an exported Python file."""
    path = folder / "arm_file.py"
    path.write_text(python_file(robot, [LEVEL], name="arm_file"))
    spec = importlib.util.spec_from_file_location("arm_file", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.model


def by_hand(robot: CalibratedModel) -> Callable[[Array], Array] | None:
    """The position by a few lines of numpy, of a Gaussian process with an RBF kernel in positions; else None."""
    if not isinstance(robot.estimator, KinematicRegressor):
        return None
    scaler, gp = robot.estimator.regressor_[0], robot.estimator.regressor_[-1]
    posterior, target = getattr(gp, "posterior_", None), robot.estimator.transformer_
    if posterior is None or gp.kernel != "rbf" or gp.trend != "linear" or not hasattr(target, "constants_"):
        return None
    trend, (rbf, _) = posterior.kernel_.k1, (posterior.kernel_.k2.k1, posterior.kernel_.k2.k2)
    points, weights = posterior.X_train_, posterior.alpha_
    scaled, lengths = points / rbf.k2.length_scale, rbf.k2.length_scale
    mean, scale = target.scaler_.mean_, target.scaler_.scale_

    def position(command: Array) -> Array:
        x = (command - scaler.mean_) / scaler.scale_
        kernel = rbf.k1.constant_value * np.exp(-0.5 * np.square(scaled - x / lengths).sum(axis=1))
        kernel += trend.k1.constant_value * (points @ x + trend.k2.sigma_0**2)
        return np.asarray(kernel @ weights * scale + mean)

    return position


def of_program(program: Path, commands: Array, robot: CalibratedModel) -> dict[str, Any]:
    """The time of a command by the C header: of many commands, less that of few."""
    few, many = commands[:1], np.resize(commands, (20 * N_CALLS, commands.shape[1]))
    n_coordinates, failures = robot.known.truth.shape[1], robot.failures is not None
    ask = partial(asked, program, n_coordinates=n_coordinates, level=LEVEL, failures=failures)
    short, long = (min(_wall_milliseconds(ask, rows) for _ in range(5)) for rows in (few, many))
    return {"median_ms": (long - short) / (len(many) - 1)}


def _wall_milliseconds(ask: Callable[[Array], object], rows: Array) -> float:
    start = time.perf_counter()
    ask(rows)
    return 1e3 * (time.perf_counter() - start)


def at_level(robot: CalibratedModel) -> Callable[[Array], object]:
    """What is timed: bounds at 90 %."""
    return lambda rows: robot.intervals(rows, LEVEL)


def places(robot: CalibratedModel) -> dict[str, Array]:
    """Commands inside, those of `train`; outside, twice as far out; and in a control loop."""
    rows = np.resize(robot.train.commands, (N_CALLS, robot.train.commands.shape[1]))
    farther = rows.mean(axis=0) + 3.0 * (rows - rows.mean(axis=0))
    outside = np.resize(farther[np.asarray(robot.is_outside(farther))], rows.shape)
    return {"inside": rows, "outside": outside, "streaming": rows}


def quantiles(call: Callable[[Array], object], commands: Array) -> dict[str, float]:
    """Median and 99 % quantile in ms: of three rounds the one of the lowest quantile; of one round of fewer calls where
    these are slow.
    """
    is_slow = float(np.median(milliseconds(call, list(commands[:5])))) > SLOW_MS
    rounds = [milliseconds(call, list(commands[:N_SLOW] if is_slow else commands)) for _ in range(1 if is_slow else 3)]
    best = min(rounds, key=lambda taken: float(np.quantile(taken, 0.99)))
    return {"median_ms": float(np.median(best)), "p99_ms": float(np.quantile(best, 0.99))}


def milliseconds(call: Callable[[Array], object], arguments: list[Array]) -> list[float]:
    """CPU time of each call, after one that is not counted: wall time is that of whatever else runs on the machine."""
    call(arguments[0])
    taken = []
    for argument in arguments:
        start = time.thread_time()
        call(argument)
        taken.append(1e3 * (time.thread_time() - start))
    return taken


def in_turns(one: Callable[[Array], object], other: Callable[[Array], object], rows: Array) -> tuple[float, float]:
    """The least CPU time in ms of two calls at many rows, which take turns."""
    for call in (one, other):
        call(rows[:1000])
    taken: list[tuple[float, float]] = []
    began = time.thread_time()
    while len(taken) < TURNS and (not taken or time.thread_time() - began < TURNS_S):
        places = [time.thread_time()]
        for call in (one, other):
            call(rows)
            places.append(time.thread_time())
        taken.append((places[1] - places[0], places[2] - places[1]))
    least = 1e3 * np.min(taken, axis=0)
    return float(least[0]), float(least[1])


def made_up() -> Iterator[CalibratedModel]:
    """A polynomial and a Gaussian process, with shells of half and of 70 % of the rows."""
    settings: dict[str, Params] = {
        "ridge": {"degree": 3, "alpha": 1e-3},
        "gp": {"kernel": "rbf", "trend": "linear", "max_iter": 5},
    }
    train, validation = arm(N_TRAIN, 0), arm(N_VALIDATION, 1)
    norm = command_norm(train.commands, standardised=False).of
    for name, params in settings.items():
        fit = FitSettings(params, skip_constant=True, seed=0, threads=1)
        norms, shells = norm(train.commands), []
        for share in (0.5, 0.7):
            core = norms <= np.quantile(norms, share)
            predicted = fitted_model(MODELS[name], fit, train.take(core)).predict(train.commands[~core])
            shells.append(Shell(train.commands[core], train.commands[~core], predicted, train.positions[~core]))
        model = FittedModel("arm", MODELS[name], "tuned", fitted_model(MODELS[name], fit, train), train)
        for method in ("scp_mapie", *(["scp_spread"] if MODELS[name].spread else [])):
            yield replace(calibrated(model, INTERVAL_METHODS[method], validation, shells, norm))


def arm(n_rows: int, seed: int) -> Samples:
    """A constant-curvature arc of 100 mm, two commands, noise of 0.1 mm."""
    rng = np.random.default_rng(seed)
    commands = rng.uniform(-1, 1, (n_rows, 2))
    bend = np.hypot(*commands.T)[:, None] + 1e-9
    position = np.hstack([100 * (1 - np.cos(bend)) / bend**2 * commands, 100 * np.sin(bend) / bend])
    return Samples(commands, position + 0.1 * rng.standard_normal(position.shape))


if __name__ == "__main__":
    main()
