"""Which parameters mattered in the studies, as a forest read them from the trials."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.runs import TUNED
from softkin.core.samples import TRAIN
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import LOOKS, PAGE, heading, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: With fewer trials there is nothing to learn from.
LEAST_TRIALS = 10
N_COLUMNS = 4
#: Longer names (characters) go on two lines.
LONG_NAME = 12
PREFIX = "param_"


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, parameter, importance, spread, n_trials: by how much R2 drops, mean and
    standard deviation, when a parameter is shuffled among the trials.

    scikit-learn's `permutation_importance` (Breiman 2001, section 10) of a forest of 32 trees that was fitted to the
    logarithm of the error on the first part of `train`, which trials have that were cut short, too: the others would be
    the good ones only. Models with fewer than `LEAST_TRIALS` are left out.
    """
    parts = [_importances(pd.read_csv(path)).assign(model=model) for model, path in results.trials.items()]
    parts = [part for part in parts if len(part)]
    return pd.concat(parts, ignore_index=True).assign(preset=TUNED, interval_method="") if parts else pd.DataFrame()


def _importances(trials: pd.DataFrame) -> pd.DataFrame:
    from sklearn.ensemble import RandomForestRegressor
    from sklearn.inspection import permutation_importance

    scored = trials[np.isfinite(trials["first_part_mm"]) & (trials["first_part_mm"] > 0)]
    names = [name for name in scored if name.startswith(PREFIX) and scored[name].nunique(dropna=False) > 1]
    if len(scored) < LEAST_TRIALS or not names:
        return pd.DataFrame()
    # Names become numbers; a parameter that a trial does not have is a value of its own.
    numbers = pd.DataFrame(
        {
            name: scored[name] if pd.api.types.is_float_dtype(scored[name]) else pd.factorize(scored[name])[0]
            for name in names
        }
    )
    score = np.log(scored["first_part_mm"])
    forest = RandomForestRegressor(32, random_state=0).fit(numbers, score)
    found = permutation_importance(forest, numbers, score, n_repeats=5, random_state=0)
    columns = {"importance": found.importances_mean, "spread": found.importances_std, "n_trials": len(scored)}
    table = pd.DataFrame({"parameter": [name.removeprefix(PREFIX) for name in names], **columns})
    return table.sort_values("importance", kind="stable", ascending=False)


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """A panel for each model, four side by side."""
    models = list(frame.groupby("model", sort=False))
    n_columns = min(len(models), N_COLUMNS)
    n_rows = -(-len(models) // n_columns)
    figure, axes = panels(n_rows, n_columns, PAGE, 1.0 + 2.4 * n_rows)
    places = [axis for row in axes for axis in row]
    for axis in places[len(models) :]:
        axis.set_axis_off()
    for axis, (model, rows) in zip(places, models, strict=False):
        colour, line = LOOKS[str(model)][0], {"linewidth": 0.8}
        axis.barh(range(len(rows)), rows["importance"], 0.7, xerr=rows["spread"], color=colour, error_kw=line)
        names = [name.replace("_", "_\n", 1) if len(name) > LONG_NAME else name for name in rows["parameter"]]
        axis.set_yticks(range(len(rows)), names, fontsize=6.5)
        axis.set_ylim(len(rows) - 0.4, -0.6)
        axis.set_xlim(left=0)
        axis.set_title(fill(results.model_titles[str(model)], 16))
        axis.grid(visible=False, axis="y")
    figure.supxlabel("permutation importance (drop of R2 of a forest that predicts the error of a trial)", fontsize=9)
    heading(figure, results, "which parameters mattered in tuning", [TRAIN])
    return figure


FIGURE = FigureSpec(
    "importance",
    "Parameter importance",
    "Which parameters decide the error of a trial on the first fold: scikit-learn's permutation importance of a forest "
    "fitted to the trials of a study. A few dozen trials tell the large from the small, no more.",
    frame,
    plot,
)
