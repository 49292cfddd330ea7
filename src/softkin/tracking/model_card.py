"""Write the card of a registered model, in Markdown: errors, guarantee, data, use."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd

from softkin.core.escaping import markdown_text
from softkin.core.metrics.interval import fewest_commands
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.core.units import unit_of
from softkin.data.audit.findings import counted
from softkin.models.estimators.weighted_mean import composition
from softkin.reporting.tables.numbers import assessed_text, number_text, share_text
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.conformal import two_sided_rank
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE
from softkin.uncertainty.promise import BY_BLOCK

#: The warning at the top of the card, by the origin of the data.
ORIGINS = {"stand-in": "STAND-IN: simulated data in place of the published ones. Nothing here is about the real robot."}
#: By the guarantee of the interval method.
GUARANTEES = {
    MARGINAL: "An interval at {level} holds its coordinate in at least {level} of cases, for commands drawn like the "
    "{n} rows of `validation` that calibrated it. That is coordinate by coordinate, not all at once.",
    BY_BLOCK: "An interval at {level} holds its coordinate in at least {level} of cases in a new block (a stretch of "
    "time, a trial, a command), like the blocks of `validation` that calibrated it. That is coordinate by coordinate.",
}
WHOLE_POSES = (
    "A joint interval at {level} ({kind}) holds the whole pose, all moving coordinates at once, in at least {level} of "
    "such cases."
)
IN_EXTRAPOLATION = (
    "In extrapolation, for commands unlike those of training, nothing is guaranteed, neither of positions nor of "
    "intervals."
)
FAILURES = (
    "Poses fail at some commands: {n_failed} of {n_rows} rows of `train` are gross errors that commands foretell. Each "
    "prediction has the probability of it (`failure_probability`). Where that is above {miss}, no interval around the "
    "prediction could hold at {level}, and intervals hold the failed poses of `train`, too."
)
#: By whether intervals are made for extrapolation.
EXTRAPOLATION_NOTES = {
    True: f"{IN_EXTRAPOLATION} Intervals there are widened by the errors of the same model on outer shells of the "
    "training commands.",
    False: IN_EXTRAPOLATION,
}


def model_card(
    model: CalibratedModel,
    *,
    registered: str,
    description: Mapping[str, Any],
    scores: pd.DataFrame,
    intervals: pd.DataFrame,
    level: float,
    caution: str | None = None,
) -> str:
    """The card in Markdown.

    Parameters:
        model: the calibrated model.
        registered: its name in the registry.
        description: the dataset's description with the `findings` of its data card.
        scores: the model's rows of point_metrics.csv, by subset.
        intervals: the rows of its method in interval_metrics.csv, at `level`, averaged over moving coordinates, by
            subset, with `joint_coverage` and `joint_size_mm` of its joint intervals.
        level: nominal level in (0, 1).
        caution: what the configuration says of its own numbers.
    """
    origin, percent, unit = description["origin"], share_text(level, 0), unit_of(description)
    lines = [f"# {markdown_text(description['title'])}", ""]
    lines += [f"**{ORIGINS[origin]}**", ""] if origin in ORIGINS else []
    lines += [f"**CAUTION**: {markdown_text(caution)}", ""] if caution else []
    commands = counted(description["n_commands"], "command")
    markers = counted(description["n_markers"], "marker")
    lines += [
        f"{model.spec.title} ({model.preset} preset){composition(model.estimator)}: "
        f"{commands} to the position of {markers}, with intervals by "
        f"{model.method.title}.",
        "",
        f"| rows | mean marker error, {unit} | 95 % below, {unit} | RMSE, {unit} | {percent} intervals cover | "
        f"mean width, {unit} | "
        "joint intervals hold |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for subset in (TEST, EXTRAPOLATION):
        point, interval = scores.loc[subset], intervals.loc[subset]
        cells = [number_text(point[name]) for name in ("euclidean_mean_mm", "euclidean_p95_mm", "rmse_mm")]
        assessable = subset == TEST or interval["n_commands"] >= fewest_commands(level)
        cells += [assessed_text(interval["coverage"], assessable), number_text(interval["mean_width_mm"])]
        cells.append(assessed_text(interval["joint_coverage"], assessable))
        lines.append(f"| {subset} | {' | '.join(cells)} |")
    guarantee = _guarantee(model, level)
    lines += ["", "## Guarantee", "", guarantee, *_of_whole_poses(model, level)]
    lines += [EXTRAPOLATION_NOTES[bool(model.shells)], ""]
    if (failures := model.failures) is not None:
        miss = share_text(1 - level, 0)
        text = FAILURES.format(n_failed=failures.n_failed, n_rows=failures.n_rows, level=percent, miss=miss)
        lines += ["## Failures", "", text, ""]
    findings = description["findings"]
    lines += ["## Data", "", _rows(description), ""]
    told = [(finding["severity"], f"{finding['sentence']} {finding['consequence']}") for finding in findings]
    lines += [f"- **{severity}**: {markdown_text(text)}" for severity, text in told]
    lines += [] if findings else ["The audit has no finding."]
    return "\n".join([*lines, "", *_use(registered, description, level)])


def _rows(description: Mapping[str, Any]) -> str:
    rows = ", ".join(f"{number} {subset}" for subset, number in description["rows"].items())
    cut = " Rows were left out (max_rows_per_subset)." if description["is_cut"] else ""
    return f"{rows} rows; origin: {description['origin']}; sha256 `{description['sha256']}`.{cut}"


def _use(registered: str, description: Mapping[str, Any], level: float) -> list[str]:
    """How to load it, in lines."""
    columns = ", ".join(f'"u{i + 1}": [0.0]' for i in range(description["n_commands"]))
    return [
        "## Use",
        "",
        "```python",
        "import mlflow, pandas",
        f'robot = mlflow.pyfunc.load_model("models:/{registered}@champion")',
        f"commands = pandas.DataFrame({{{columns}}})",
        f"# in {unit_of(description)}: y_pred_m1_x, ..., lower_m1_x, ..., upper_m1_x, ..., joint_lower_m1_x, ..., "
        "joint_upper_m1_x, ...",
        f'robot.predict(commands, params={{"confidence_level": {level:g}}})',
        "robot.unwrap_python_model().model  # the calibrated model: regions and p-values, too",
        "```",
        "",
    ]


def _of_whole_poses(model: CalibratedModel, level: float) -> list[str]:
    """What joint intervals at the level promise, if anything."""
    region = model.joint
    if region.promise is not None and not region.promise.holds(level):
        return []
    return [WHOLE_POSES.format(level=share_text(level, 0), kind=region.shape.kind)]


def _guarantee(model: CalibratedModel, level: float) -> str:
    """What the intervals of the model promise at the level; `method.guarantee` is that of 90 %."""
    kind, promise, percent = model.method.guarantee, model.joint.promise, share_text(level, 0)
    if kind == BY_BLOCK and promise is not None and not promise.holds(level, model.method.rank is two_sided_rank):
        return f"Intervals by this method have {NO_GUARANTEE} at {percent}: too few blocks of rows are held out."
    if kind in GUARANTEES:
        return GUARANTEES[kind].format(level=percent, n=len(model.known.truth))
    why = ": too few blocks of rows are held out" if "block" in kind else ""
    return f"Intervals by this method have {kind}{why}."
