"""What a calibrated model is, in eight lines."""

from __future__ import annotations

from typing import Any

import numpy as np

from softkin.core.samples import Array
from softkin.models.estimators.weighted_mean import composition
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE, WEAK
from softkin.uncertainty.promise import BY_BLOCK

#: What is said of intervals, by their guarantee; of one without blocks enough that is itself said.
PROMISES = {
    MARGINAL: "an interval at 90 % holds its coordinate in 90 % of cases; nothing is promised outside",
    BY_BLOCK: "an interval at 90 % holds its coordinate in 90 % of cases of a new block; nothing is promised outside",
    **dict.fromkeys((WEAK, NO_GUARANTEE), "none: intervals by this method have no guarantee"),
}


def described(robot: Any) -> str:
    """Robot, model, method, error inside and outside, promise, data, date; what is not known has no line."""
    known, about, unit = robot.known, robot.about, robot.names.unit
    n_commands, n_markers = robot.train.commands.shape[1], known.truth.shape[1] // 3
    inside = _marker_error(known.truth - known.calibration)
    members, n_rows = composition(robot.estimator), len(robot.train.commands)
    lines = {
        "robot": f"{robot.dataset}, {_counted(n_commands, 'command')} to {_counted(n_markers, 'marker')}",
        "model": f"{robot.spec.title} ({robot.preset}){members}, fitted on {n_rows} rows",
        "intervals": f"{robot.method.title}, calibrated on {len(known.truth)} rows",
        "inside": f"{inside:.3g} {unit} mean marker error on the calibration set",
        "outside": "nothing is known of errors in extrapolation",
        "promise": PROMISES.get(robot.method.guarantee, f"none: {robot.method.guarantee}"),
        "data": f"sha256 {about['data'][:16]} of the rows of `train`" if "data" in about else None,
        "date": about.get("date"),
    }
    if robot.shells:
        shell = robot.shells[-1]
        error = _marker_error(shell.truth - shell.predicted)
        lines["outside"] = f"{error:.3g} {unit} mean marker error beyond the largest core of `train`"
    return "\n".join(f"{name:<10} {text}" for name, text in lines.items() if text)


def _marker_error(residuals: Array) -> float:
    """Mean distance of markers from where they are predicted; residuals (n_rows, n_coordinates)."""
    return float(np.linalg.norm(residuals.reshape(len(residuals), -1, 3), axis=2).mean())


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"
