"""Write the golden files anew, when the format of calibrated models is raised: python -m tests.golden.write."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import joblib
import numpy as np

from softkin.core.files import write_json
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.file_format import FORMAT
from tests.exported_robots import remembering, small

FOLDER = Path(__file__).parent
COMMANDS = [[0.1, -0.2], [0.6, 0.5], [1.9, -1.4]]
LEVELS = [0.8, 0.9]
ROBOTS: dict[str, Callable[[], CalibratedModel]] = {
    "curvature": lambda: small("huber"),
    "gaussian_process": lambda: small("gp"),
    "remembers": remembering,
}


def answers(robot: CalibratedModel) -> dict[str, Any]:
    """What a robot answers, for JSON."""
    return {
        "predict": np.asarray(robot.predict(COMMANDS)).tolist(),
        "follow": np.asarray(robot.follow(COMMANDS)).tolist(),
        "intervals": np.asarray(robot.intervals(COMMANDS, LEVELS)).tolist(),
        "is_outside": np.asarray(robot.is_outside(COMMANDS)).tolist(),
        "box": robot.box(0.9).tolist(),
        "p_values": np.asarray(robot.p_values(COMMANDS, robot.predict(COMMANDS) + 0.1)[1]).tolist(),
    }


def main() -> None:
    """Write a file for each robot, and what all of them answer."""
    said: dict[str, Any] = {"format": FORMAT, "robots": {}}
    for name, made in ROBOTS.items():
        robot, path = replace(made()), FOLDER / f"{name}.joblib"
        joblib.dump(robot, path, compress=9)
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        said["robots"][name] = {"sha256": digest} | answers(robot)
    write_json(FOLDER / "answers.json", said)


if __name__ == "__main__":
    main()
