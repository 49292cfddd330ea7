"""Choose the interval method of a dataset, on `validation` alone: nothing of `test` is looked at."""

from __future__ import annotations

import dataclasses
import logging
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from sklearn.model_selection import KFold

from softkin.evidence import Evidences, Run
from softkin.files import replacing
from softkin.interface import (
    AUTO,
    MARGINAL,
    OUTER,
    PAPERS_LEVEL,
    PAPERS_RUN,
    Array,
    Evidence,
    IntervalMethod,
    SoftkinError,
    informative_coordinates,
)
from softkin.metrics.interval import winkler_scores
from softkin.tables.selection import deployed, searched_runs, selection

logger = logging.getLogger("softkin")

N_FOLDS = 5
#: Whose errors a few failed rows cannot move.
ROBUST_RUNS = (("huber", OUTER),)


def nearest_level(confidence_levels: list[float]) -> float:
    """The configured level nearest to the paper's: methods are compared at it."""
    return min(confidence_levels, key=lambda level: abs(level - PAPERS_LEVEL))


def run_of_choice(parameters: Mapping[Run, str | Path], objective: str) -> Run:
    """The run that is deployed; `parameters` is (model, preset) -> file of what its study found."""
    runs = searched_runs({("", *run): file for run, file in parameters.items()})
    best = deployed(selection(runs, objective)).iloc[0]
    return best["model"], best["preset"]


def shell_runs(runs: Collection[Run], parameters: Mapping[Run, str | Path], objective: str) -> list[Run]:
    """The runs, of all `runs`, that get intervals for commands outside `train`: refitting all would take too long. The
    paper's, the chosen one, the robust ones; `parameters` as for `run_of_choice`, empty where nothing was searched.
    """
    chosen = [run_of_choice(parameters, objective)] if parameters else []
    return [run for run in dict.fromkeys([PAPERS_RUN, *chosen, *ROBUST_RUNS]) if run in runs]


def shown_runs(choice: str | Path) -> set[Run]:
    """The runs whose intervals are shown at length: the paper's, and those that were candidates."""
    candidates = pd.read_csv(choice, dtype=str)
    return {PAPERS_RUN, *zip(candidates["model"], candidates["preset"], strict=True)}


def deployed_choice(choice: str | Path) -> pd.Series | None:
    """The row of a `choice` that the calibrated model has; None where every candidate has a learner of its own."""
    candidates = pd.read_csv(choice)
    around_model = candidates[candidates["deployed"]]
    return None if around_model.empty else around_model.iloc[0]


def choose(
    evidences: Evidences,
    *,
    methods: Mapping[str, IntervalMethod],
    runs: Collection[Run],
    seed: int,
    regime: str,
    choice: str | Path,
) -> None:
    """Write the `choice` (CSV: model, preset, interval_method, confidence_level, cv_winkler_mm, chosen, deployed,
    outside), best first.

    The best is `chosen`; `deployed` is the best around the prediction of a model, which the calibrated model has: a
    method on quantiles has a learner of its own. `outside` names the method that gives its intervals outside the
    training region: by the `regime` `auto` that of this name, where there are shells of this run, else the same.

    Candidates are the methods with a marginal guarantee around one of `runs`, and those on quantiles. Each is
    calibrated on four fifths of `validation` and scored on the rest, five times over: the mean Winkler score over
    moving coordinates. Ties go to the method that comes first.

    Raises:
        SoftkinError: no method is calibrated.
    """
    level = nearest_level(evidences.levels)
    moving = informative_coordinates(evidences.train.positions)
    rows: list[dict[str, Any]] = []
    for name, method in methods.items():
        if method.guarantee != MARGINAL or method.on == "shells":  # which differ only outside, where no row is scored
            continue
        for run, evidence in evidences.of(method.on):
            if method.on != "quantiles" and run not in runs:
                continue
            assert isinstance(evidence, Evidence)
            scores = []
            for part, outside in parts(evidence, seed):
                bounds = method.intervals(part, evidences.levels)[evidences.levels.index(level)]
                scores.append(winkler_scores(evidence.truth[outside], bounds, level)[:, moving].mean(axis=1))
            key = {"model": run[0], "preset": run[1], "interval_method": name, "confidence_level": level}
            rows.append(key | {"cv_winkler_mm": float(np.concatenate(scores).mean())})
    if not rows:
        raise SoftkinError(
            "no configured interval method is calibrated, so none can be chosen\n"
            "  mend: add scp_mapie to interval_methods"
        )
    frame = pd.DataFrame(rows).sort_values("cv_winkler_mm", kind="stable", ignore_index=True)
    frame["chosen"] = frame.index == 0
    around_model = frame["interval_method"].map(lambda name: methods[name].on != "quantiles")
    frame["deployed"] = around_model & ~around_model.shift(fill_value=False).cummax()
    shells = {run for run, _ in evidences.of("shells")} if regime == AUTO and AUTO in methods else set()
    has_shells = np.array([run in shells for run in zip(frame["model"], frame["preset"], strict=True)])
    goes_on = frame["deployed"] & has_shells
    frame["outside"] = frame["interval_method"].mask(goes_on, AUTO)
    with replacing(choice) as temporary:
        frame.to_csv(temporary, index=False)
    best = frame.iloc[0]
    if regime == AUTO and not goes_on.any():
        logger.warning("outside the training region intervals are as inside: no method `%s`, or no shells", AUTO)
    logger.info("chosen: %s around %s %s", methods[best["interval_method"]].title, best["model"], best["preset"])


def parts(evidence: Evidence, seed: int) -> Iterator[tuple[Evidence, NDArray[np.intp]]]:
    """The calibration rows split again: evidence calibrated on most of them, whose `new` rows are the others."""
    axis = 0 if evidence.calibration.ndim == 2 else 1
    splitter = KFold(N_FOLDS, shuffle=True, random_state=seed)
    for inside, outside in splitter.split(evidence.truth):
        yield resplit(evidence, inside, outside, axis), outside


def resplit(evidence: Evidence, inside: NDArray[np.intp], outside: NDArray[np.intp], axis: int) -> Evidence:
    """Calibrated on the calibration rows `inside`, asked about those `outside`."""
    optional: dict[str, Array] = {}
    for field in ("spread", "commands"):
        whole = getattr(evidence, f"calibration_{field}")
        if whole is not None:
            optional |= {f"calibration_{field}": whole[inside], f"new_{field}": whole[outside]}
    return dataclasses.replace(
        evidence,
        calibration=evidence.calibration.take(inside, axis),
        truth=evidence.truth[inside],
        new=evidence.calibration.take(outside, axis),
        **optional,
    )
