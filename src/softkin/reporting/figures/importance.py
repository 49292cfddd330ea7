"""Importance of each model's parameters in its study, by a forest fitted to the trials."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.runs import TUNED
from softkin.core.samples import TRAIN, Array
from softkin.reporting.figures.spec import DatasetResults, FigureSpec
from softkin.reporting.figures.style import LOOKS, PAGE, heading, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Studies with fewer trials are left out.
LEAST_TRIALS = 10
#: How often each parameter is shuffled.
N_REPEATS = 5
N_COLUMNS = 4
#: Longer names (characters) go on two lines.
LONG_NAME = 12
PREFIX = "param_"


def frame(results: DatasetResults) -> pd.DataFrame:
    """Columns model, preset, interval_method, parameter, importance, spread, n_trials: by how much R2 drops, mean and
    standard deviation, when a parameter is shuffled among the trials.

    The permutation importance (Breiman 2001, section 10; that of scikit-learn) of a forest of 32 trees that was fitted
    to the logarithm of the error on the first fold of `train`, which pruned trials have, too: complete trials alone
    would be the good ones only. Models with fewer than `LEAST_TRIALS` are left out.
    """
    parts = [_importances(read_csv(path)).assign(model=model) for model, path in results.trials.items()]
    parts = [part for part in parts if len(part)]
    return pd.concat(parts, ignore_index=True).assign(preset=TUNED, interval_method="") if parts else pd.DataFrame()


def _importances(trials: pd.DataFrame) -> pd.DataFrame:
    scored = trials[np.isfinite(trials["first_part_mm"]) & (trials["first_part_mm"] > 0)]
    names = [name for name in scored if name.startswith(PREFIX) and scored[name].nunique(dropna=False) > 1]
    if len(scored) < LEAST_TRIALS or not names:
        return pd.DataFrame()
    # Categories become numbers; for a forest the absence of a parameter (NaN) is a value of its own.
    numbers = [
        scored[name] if pd.api.types.is_float_dtype(scored[name]) else pd.factorize(scored[name])[0] for name in names
    ]
    drops = permutation_drops(
        np.column_stack(numbers).astype(np.float64), np.log(scored["first_part_mm"].to_numpy(np.float64))
    )
    columns = {"importance": drops.mean(axis=1), "spread": drops.std(axis=1), "n_trials": len(scored)}
    table = pd.DataFrame({"parameter": [name.removeprefix(PREFIX) for name in names], **columns})
    return table.sort_values("importance", kind="stable", ascending=False)


def permutation_drops(numbers: Array, score: Array) -> Array:
    """By how much R2 drops, (n_parameters, N_REPEATS), when a forest predicts the `score` (n_trials,) from `numbers`
    (n_trials, n_parameters) of which one column is shuffled.

    As scikit-learn's `permutation_importance`, whose shuffled columns these are; the forest predicts all of them in one
    call, where a hundred calls take longer than fitting it.
    """
    from sklearn.ensemble import RandomForestRegressor
    from sklearn.inspection import permutation_importance
    from sklearn.metrics import r2_score

    forest = RandomForestRegressor(32, random_state=0).fit(numbers, score)
    shuffled: list[Array] = []

    def keep(_forest: object, rows: Array, _score: Array) -> float:
        shuffled.append(rows.copy())
        return 0.0

    permutation_importance(forest, numbers, score, scoring=keep, n_repeats=N_REPEATS, random_state=0)
    predicted = forest.predict(np.concatenate(shuffled)).reshape(len(shuffled), -1)
    first, *others = (r2_score(score, of_rows) for of_rows in predicted)
    return np.asarray(first - np.reshape(others, (-1, N_REPEATS)))


def plot(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    """Draw a panel for each model, four side by side."""
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
    heading(figure, results, "importance of parameters in the studies", [TRAIN])
    return figure


FIGURE = FigureSpec(
    "importance",
    "Parameter importance",
    "Permutation importance of each parameter in a forest that predicts a trial's error on the first fold, from the "
    "trials of a study. A long bar is a parameter worth searching; a bar near zero is one whose range could be fixed. "
    "With a few dozen trials only large differences between bars mean anything; the black lines are one standard "
    "deviation.",
    frame,
    plot,
)
