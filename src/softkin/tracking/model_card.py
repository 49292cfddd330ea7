"""The card of a registered model, in Markdown: how good, what is promised, on which data, how to use it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd

from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.data.audit.findings import counted
from softkin.reporting.tables.paper_layout import format_number
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.intervals.spec import MARGINAL

#: What to warn of before anything else, by the origin of the data.
ORIGINS = {"stand-in": "STAND-IN: simulated data in place of the published ones. Nothing here is about the real robot."}
PROMISES = {
    True: "An interval at {level:.0%} holds the coordinate it is about in at least {level:.0%} of cases, for commands "
    "drawn like the {n} rows of `validation` that calibrated it. That is coordinate by coordinate, not all at once.",
    False: "Of intervals by this method, nothing is promised.",
}
#: Whether intervals outside the training region are made for there.
BEYOND = {
    True: "Outside the range of the training commands nothing is promised, neither of positions nor of intervals. "
    "Intervals there are widened, by what the same model got wrong outside inner cores of the training commands.",
    False: "Outside the range of the training commands nothing is promised, neither of positions nor of intervals.",
}


def model_card(
    model: CalibratedModel,
    *,
    registered: str,
    about: Mapping[str, Any],
    scores: pd.DataFrame,
    intervals: pd.DataFrame,
    level: float,
) -> str:
    """Markdown; `scores` are the model's rows of point_metrics.csv by subset, `intervals` those of its method in
    interval_metrics.csv, averaged over moving coordinates at `level`, by subset. `about` is the dataset's description
    with its `findings`.
    """
    lines = [f"# {about['title']}", ""]
    lines += [f"**{ORIGINS[about['origin']]}**", ""] if about["origin"] in ORIGINS else []
    lines += [
        f"{model.spec.title} ({model.preset} preset): {counted(about['n_commands'], 'command')} to the position of "
        f"{counted(about['n_markers'], 'marker')}, with intervals by {model.method.title}.",
        "",
        f"| rows | mean marker error, mm | 95 % below, mm | RMSE, mm | {level:.0%} intervals cover | mean width, mm |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for subset in (TEST, EXTRAPOLATION):
        point, interval = scores.loc[subset], intervals.loc[subset]
        numbers = [format_number(point[name]) for name in ("euclidean_mean_mm", "euclidean_p95_mm", "rmse_mm")]
        numbers += [f"{interval['coverage']:.1%}", format_number(interval["mean_width_mm"])]
        lines.append(f"| {subset} | {' | '.join(numbers)} |")
    promise = PROMISES[model.method.guarantee == MARGINAL].format(level=level, n=len(model.known.truth))
    lines += ["", "## What is promised", "", promise]
    lines += [BEYOND[bool(model.shells)], ""]
    lines += ["## Data", "", _rows(about), ""]
    lines += [f"- **{found['severity']}**: {found['sentence']} {found['consequence']}" for found in about["findings"]]
    lines += [] if about["findings"] else ["The audit has no finding."]
    return "\n".join([*lines, "", *_use(registered, about["n_commands"], level)])


def _rows(about: Mapping[str, Any]) -> str:
    rows = ", ".join(f"{number} {subset}" for subset, number in about["rows"].items())
    cut = " Rows were left out to try things out." if about["is_cut"] else ""
    return f"{rows} rows; origin: {about['origin']}; sha256 `{about['sha256']}`.{cut}"


def _use(registered: str, n_commands: int, level: float) -> list[str]:
    """How to load it, in lines."""
    columns = ", ".join(f'"u{i + 1}": [0.0]' for i in range(n_commands))
    return [
        "## Use",
        "",
        "```python",
        "import mlflow, pandas",
        f'robot = mlflow.pyfunc.load_model("models:/{registered}@champion")',
        f"commands = pandas.DataFrame({{{columns}}})",
        "# in mm: y_pred_m1_x, ..., lower_m1_x, ..., upper_m1_x, ...",
        f'robot.predict(commands, params={{"confidence_level": {level:g}}})',
        "robot.unwrap_python_model().model  # all of it: boxes and p-values too",
        "```",
        "",
    ]
