"""What recalibration on a few labelled poses does to coverage and width, and after how many poses the alarm goes off.

python -m benchmarks.recalibration [MIRROR]: simulated arms with backlash, on which the rules were chosen; with a folder
that holds FINGER.json the recorded sessions of FINGER, too.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from softkin.core.runs import Run
from softkin.core.samples import TEST, TRAIN, VALIDATION, Samples
from softkin.data.prepare import prepare
from softkin.data.table import read_subset
from softkin.evaluation.score_recorded import Member, RecordedRun, in_time, next_sessions, over_time, part, relabelled
from softkin.models import MODELS
from softkin.training.kinematic_model import STATIC, FitSettings, fitted_model
from softkin.uncertainty.alarm import Watch
from softkin.uncertainty.calibrated import FittedModel, calibrated
from softkin.uncertainty.intervals import INTERVAL_METHODS
from tests.recorded_robot import recorded_arm

HOUSE = Path(__file__).parents[1]
LEVEL, RATE, N_SHUFFLES = 0.9, 0.01, 200
#: What the study of the Gaussian process chose on `train` of finger_recorded.
GP = {"kernel": "matern32", "trend": "linear", "initial_length_scale": 3.64, "initial_noise": 3.7e-5}
GP |= {"learning_rows": 200, "max_iter": 40}
PLAYED = {"memory": "play", "widths": "all", "zeros": True}
BASE = {"origin": [0, 0, 0], "axis": [0, 0, 1]}


def run(memory: dict[str, Any]) -> RecordedRun:
    """The Gaussian process with this memory."""
    settings = FitSettings(GP, True, 0, 1, base=BASE, memory=memory)
    return RecordedRun(Run("gp", "tuned"), [Member(MODELS["gp"], settings, 1.0)], 0, LEVEL)


def finger(mirror: Path) -> Samples:
    """The in-domain rows of FINGER in the order of their recording."""
    source = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]["finger_recorded"]
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "table.parquet"
        order = HOUSE / "resources" / "published" / source["order"]["file"]
        about = Path(folder) / "about.json"
        prepare(
            mirror / source["file"], dataset="finger", source=source, table=table, description=about, order_table=order
        )
        return in_time([read_subset(table, subset) for subset in (TRAIN, VALIDATION, TEST)])


def scores(name: str, rows: Samples) -> Iterator[dict[str, Any]]:
    """Scores of each next session, with memory and without."""
    assert rows.recording is not None
    session = rows.recording.session
    for told in (STATIC, PLAYED):
        for known, new in next_sessions(sorted(set(session.tolist()))):
            of_part = part(rows.take(np.isin(session, known)), rows.take(session == new), run(told))
            label = f"{new} after {'+'.join(map(str, known))}"
            key = {"robot": name, "memory": told["memory"]}
            width = 0.0
            for row in (*list(over_time("", label, of_part, LEVEL))[:1], *relabelled(label, of_part, LEVEL, 0)):
                width = width or row["mean_width_mm"]
                yield key | row | {"width_ratio": row["mean_width_mm"] / width}


def alarms(rows: Samples) -> tuple[list[int], float]:
    """Poses until the alarm in session 2 of a model of session 1, over seeds; and the rate of alarms in shuffles of
    calibration rows and as many rows like them.
    """
    assert rows.recording is not None
    session = rows.recording.session
    of_part = part(rows.take(session == 1), rows.take(session == 2), run(PLAYED))
    noticed = []
    for seed in range(20):
        watch = Watch(of_part.known, "xyz", RATE, seed)
        noticed.append(next((row + 1 for row, error in enumerate(of_part.new) if watch.judge(error)), 0))
    false = 0
    for seed in range(N_SHUFFLES):
        shuffled = np.random.default_rng(seed).permutation(of_part.known)
        watch = Watch(shuffled[: len(shuffled) // 2], "xyz", RATE, seed)
        false += any(watch.judge(error) is not None for error in shuffled[len(shuffled) // 2 :])
    return noticed, false / N_SHUFFLES


def milliseconds(rows: Samples) -> float:
    """Median time of `state.step`, with its interval."""
    settings = run(PLAYED).members[0].settings
    fitted, held_out = rows.take(np.arange(len(rows)) % 5 > 0), rows.take(np.arange(len(rows)) % 5 == 0)
    model = FittedModel("finger", MODELS["gp"], "tuned", fitted_model(MODELS["gp"], settings, fitted), fitted)
    state = calibrated(model, INTERVAL_METHODS["scp_crepes"], held_out).start(session=1)
    seconds = []
    for command in rows.commands[:300]:
        start = time.perf_counter()
        state.step(command)
        seconds.append(time.perf_counter() - start)
    return 1000 * float(np.median(seconds))


def main(mirror: str | None = None) -> None:
    """Print the tables. `mirror` is a folder that holds FINGER.json."""
    zeros = (0.0, 2.0, -1.0)
    robots = [(f"arm {seed}", recorded_arm(900, backlash=0.04, zeros_mm=zeros, seed=seed)) for seed in range(5)]
    if mirror is not None:
        robots.append(("finger", finger(Path(mirror))))
    frame = pd.DataFrame([row for name, rows in robots for row in scores(name, rows)])
    frame["robot"] = frame["robot"].str.replace(r" \d", "", regex=True)
    key = ["robot", "memory", "subset", "method", "n_recalibration_poses"]
    print(frame.groupby(key, sort=False)[["rmse_mm", "coverage", "width_ratio"]].mean().round(3).to_string())
    noticed, false = alarms(robots[-1][1])
    print(f"{robots[-1][0]}: session 2 noticed after {min(noticed)} to {max(noticed)} poses", end="; ")
    print(f"{false:.1%} of {N_SHUFFLES} shuffles alarm")
    print(f"{robots[-1][0]}: state.step takes {milliseconds(robots[-1][1]):.2f} ms")


if __name__ == "__main__":
    main(*sys.argv[1:])
