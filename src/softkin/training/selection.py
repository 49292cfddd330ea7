"""Choose the run that is deployed by scores on `train`: for interpolation, for extrapolation, or for both."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from softkin.core.files import read_json
from softkin.core.runs import BOTH, INTERPOLATION, OUTER, Run
from softkin.core.samples import EXTRAPOLATION, TEST
from softkin.models.spec import PAPERS_RUN

CV, SHELL = "cv_mae_mm", "shell_mae_mm"
#: Scores (mm) below this count as this in the geometric mean, whose logarithm has no bound at 0.
NEGLIGIBLE_MM = 1e-9
#: Of fewer runs a rank correlation is chance: three have six orders.
FEWEST_RANKED = 5


def searched_runs(parameters: Mapping[tuple[str, str, str], str | Path]) -> pd.DataFrame:
    """Scores of the runs behind the files of best `parameters`, (dataset, model, preset) -> file, a row each.

    Columns: dataset, model, preset, target_space, cv_mae_mm, shell_mae_mm (NaN where there is no such score).
    """
    rows = []
    for (dataset, model, preset), path in parameters.items():
        best = read_json(path)
        # A score that is infinite is written as null, one that was not asked for is not written.
        scores = {name: best.get(name, np.nan) for name in (CV, SHELL)}
        scores = {name: np.inf if score is None else score for name, score in scores.items()}
        key = {"dataset": dataset, "model": model, "preset": preset, "target_space": best["target_space"]}
        rows.append(key | scores)
    return pd.DataFrame(rows)


def on_front(runs: pd.DataFrame) -> pd.Series:
    """Which runs of a dataset no other beats in both scores (the Pareto front); equal ones are on it together."""
    scores = runs[[CV, SHELL]].to_numpy()
    no_worse = (scores[:, None] >= scores[None]).all(axis=2)
    beaten = no_worse & (scores[:, None] > scores[None]).any(axis=2)
    return pd.Series(np.logical_not(beaten.any(axis=1)), index=runs.index)


#: Factor on the geometric mean of a run that is not on the Pareto front, so that it loses a tie.
OFF_FRONT = 1 + 1e-12


def _both(runs: pd.DataFrame) -> pd.Series:
    """Geometric mean of the two scores (mm), so that a factor counts the same in either; the lowest is on the front."""
    logarithms = np.log(runs[[CV, SHELL]].clip(lower=NEGLIGIBLE_MM)).mean(axis=1, skipna=False)
    means = np.exp(logarithms)
    return means.where(on_front(runs), OFF_FRONT * means)


#: Score (n_runs,) that a run is chosen by, by objective: the lowest wins.
OBJECTIVES: dict[str, Callable[[pd.DataFrame], pd.Series]] = {
    INTERPOLATION: lambda runs: runs[CV],
    EXTRAPOLATION: lambda runs: runs[SHELL],
    BOTH: _both,
}


def selection(runs: pd.DataFrame, objective: str) -> pd.DataFrame:
    """The run of lowest score, and the runner-up among other models: one row per dataset and objective that has scores;
    `deployed` marks those of the configured `objective`.

    `runs` is as `searched_runs` returns it. Ties go to the run that comes first.
    """
    rows = []
    for dataset, pool in runs.groupby("dataset", sort=False):
        for name, scored in OBJECTIVES.items():
            scores = scored(pool)
            if scores.isna().any():
                continue
            ranked = pool.assign(score=scores).sort_values("score", kind="stable").reset_index(drop=True)
            best, others = ranked.iloc[0], ranked[ranked["model"] != ranked.loc[0, "model"]]
            rows.append(
                {
                    "dataset": dataset,
                    "objective": name,
                    **best[["model", "preset", "target_space", CV, SHELL]],
                    "runner_up": "" if others.empty else others.iloc[0]["model"],
                    "runner_up_ratio": float("nan") if others.empty else others.iloc[0]["score"] / best["score"],
                    "pool": " ".join(dict.fromkeys(ranked["model"])),
                    "deployed": name == objective,
                }
            )
    return pd.DataFrame(rows)


def runs_with_errors(runs: pd.DataFrame, point: pd.DataFrame) -> pd.DataFrame:
    """The searched `runs` with their mean absolute errors on test and extrapolation, of the `point` metrics.

    Spearman's rank correlation of either score with the error on extrapolation is the same in each row of a dataset,
    and NaN where it has fewer than `FEWEST_RANKED` runs. `on_front` says which runs no other of the dataset beats in
    both scores.
    """
    key = ["dataset", "model", "preset"]
    errors = point.pivot_table(index=key, columns="subset", values="mae_mm")
    result = runs.copy()
    fronts = [on_front(pool) for _, pool in runs.groupby("dataset")]
    result["on_front"] = pd.concat(fronts).reindex(runs.index)
    for subset in (TEST, EXTRAPOLATION):
        result[f"{subset}_mae_mm"] = errors[subset].reindex(pd.MultiIndex.from_frame(runs[key])).to_numpy()
    for name, score in (("cv", CV), ("shell", SHELL)):
        correlations = {
            dataset: pool[score].rank().corr(pool[f"{EXTRAPOLATION}_mae_mm"].rank(), min_periods=FEWEST_RANKED)
            for dataset, pool in result.groupby("dataset")
        }
        result[f"{name}_rank_correlation"] = result["dataset"].map(correlations)
    return result


def deployed(chosen: pd.DataFrame) -> pd.DataFrame:
    """The rows of a selection that are deployed, one per dataset."""
    return chosen[chosen["deployed"]].reset_index(drop=True)


def run_of_choice(parameters: Mapping[Run, str | Path], objective: str) -> Run:
    """The run that is deployed; `parameters` is run -> file of its best parameters."""
    runs = searched_runs({("", *run): file for run, file in parameters.items()})
    best = deployed(selection(runs, objective)).iloc[0]
    return Run(best["model"], best["preset"])


def deployable_runs(runs: Collection[Run], parameters: Mapping[Run, str | Path], objective: str) -> list[Run]:
    """Those of `runs` that can be deployed: the chosen one; all where nothing was searched.

    `parameters` is as for `run_of_choice`, empty where nothing was searched.
    """
    return [run_of_choice(parameters, objective)] if parameters else list(runs)


def runs_to_refit(
    runs: Collection[Run], parameters: Mapping[Run, str | Path], objective: str, cheap_models: Collection[str]
) -> list[Run]:
    """Those of `runs` that are refitted on folds and bootstrap samples of `train`: the paper's and those that can be
    deployed, of cheap models. Refitting all would take as long as half of all studies.
    """
    candidates = dict.fromkeys([PAPERS_RUN, *deployable_runs(runs, parameters, objective)])
    return [run for run in candidates if run in runs and run.model in cheap_models]


def shell_runs(
    runs: Collection[Run], parameters: Mapping[Run, str | Path], objective: str, robust_models: Collection[str]
) -> list[Run]:
    """Those of `runs` that get intervals for extrapolation: the paper's, the chosen one, the `outer` ones of robust
    models. Refitting all would take too long.

    `parameters` is as for `run_of_choice`, empty where nothing was searched.
    """
    chosen = deployable_runs([], parameters, objective)
    robust = [Run(model, OUTER) for model in robust_models]
    return [run for run in dict.fromkeys([PAPERS_RUN, *chosen, *robust]) if run in runs]
