"""Choose the interval method of a dataset by cross-validated typical Winkler scores on `validation`."""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from sklearn.model_selection import GroupKFold, KFold

from softkin.core.csv_tables import read_csv, write_csv
from softkin.core.errors import ConfigError
from softkin.core.failed_parts import INTERVAL_METHODS, of_part
from softkin.core.metrics.interval import typical_winkler, winkler_scores
from softkin.core.runs import Run, nearest_level
from softkin.core.samples import MIN_CALIBRATION_ROWS, TRAIN, VALIDATION, Array, informative_coordinates
from softkin.data.audit.gross_rows import gross_rows
from softkin.models.spec import PAPERS_RUN
from softkin.uncertainty.calibration_data import PointCalibration, QuantileCalibration, ShellCalibration
from softkin.uncertainty.intervals.spec import AUTO, MARGINAL, IntervalMethod
from softkin.uncertainty.stored_outputs import StoredOutputs

logger = logging.getLogger("softkin")

N_FOLDS = MIN_CALIBRATION_ROWS
#: The score (mm) that candidates are compared by: the lowest is chosen.
DECISIVE = "cv_winkler_typical_mm"

#: Calibration data whose calibration rows can be split again.
Resplittable = PointCalibration | QuantileCalibration


def shown_runs(choice: str | Path) -> set[Run]:
    """The runs whose intervals are shown at length: the paper's and the candidates of a `choice`."""
    candidates = read_csv(choice, dtype=str)
    return {PAPERS_RUN, *map(Run, candidates["model"], candidates["preset"])}


def deployed_choice(choice: str | Path) -> pd.Series | None:
    """The row of a `choice` that is deployed; None where no candidate is around a point model."""
    candidates = read_csv(choice)
    around_model = candidates[candidates["deployed"]]
    return None if around_model.empty else around_model.iloc[0]


def choose(
    outputs: StoredOutputs,
    *,
    methods: Mapping[str, IntervalMethod[Any]],
    runs: Collection[Run],
    seed: int,
    regime: str,
    choice: str | Path,
) -> None:
    """Write the candidates with their cross-validated scores, best first.

    Candidates are the in-domain methods with a marginal guarantee around one of `runs`, and those calibrated on
    quantiles. Each is calibrated on four folds of `validation` and scored on the held-out one, five times: a row's
    score is the mean Winkler score over moving coordinates. The typical one of all rows decides, their geometric mean,
    which a handful of failed rows cannot turn. Beside it stand the means over rows, with and without the gross errors
    that the audit finds in `train` and `validation`. Ties go to the method that comes first; where the calibration set
    is so small that all are infinite, the lowest configured level decides.

    The best is `chosen`. `deployed` is the best around a point model, which the calibrated model holds. `outside` names
    the method of its intervals in extrapolation: `auto` if the regime is `auto` and the run has shells, else the same.

    Parameters:
        outputs: stored outputs of the dataset.
        methods: interval methods by name; earlier ones win ties.
        runs: runs that may be deployed.
        seed: of the folds.
        regime: one of `REGIMES`.
        choice: output (CSV: model, preset, interval_method, confidence_level, cv_winkler_typical_mm,
            cv_winkler_mm, cv_winkler_without_gross_mm, chosen, deployed, outside).

    Raises:
        ConfigError: no method is calibrated.
    """
    frame = pd.DataFrame(list(_scored_candidates(outputs, methods, runs, seed)))
    if frame.empty:
        raise ConfigError(
            "no configured interval method is calibrated, so none can be chosen",
            where="interval_methods",
            fix="add scp_mapie to interval_methods",
        )
    frame = frame.sort_values([DECISIVE, "tie"], kind="stable", ignore_index=True).drop(columns="tie")
    frame["chosen"] = frame.index == 0
    around_model = frame["interval_method"].map(lambda name: methods[name].calibrated_on.is_around_a_model)
    frame["deployed"] = around_model & ~around_model.shift(fill_value=False).cummax()
    shells = {run for run, _ in outputs.of(ShellCalibration)} if regime == AUTO and AUTO in methods else set()
    has_shells = np.array([run in shells for run in zip(frame["model"], frame["preset"], strict=True)])
    by_shells = frame["deployed"] & has_shells
    frame["outside"] = frame["interval_method"].mask(by_shells, AUTO)
    write_csv(choice, frame)
    best = frame.iloc[0]
    if np.isinf(best[DECISIVE]):
        level, lowest = (f"{100 * at:g} %" for at in (best["confidence_level"], outputs.levels[0]))
        logger.warning("validation has too few rows for intervals at %s: methods are compared at %s", level, lowest)
    if regime == AUTO and not by_shells.any():
        logger.warning("intervals in extrapolation are as in-domain: no method `%s`, or no shells", AUTO)
    logger.info("chosen: %s around %s %s", methods[best["interval_method"]].title, best["model"], best["preset"])


def _scored_candidates(
    outputs: StoredOutputs, methods: Mapping[str, IntervalMethod[Any]], runs: Collection[Run], seed: int
) -> Iterator[dict[str, Any]]:
    """A row per candidate, with its cross-validated scores."""
    regular = ~gross_rows({TRAIN: outputs.train, VALIDATION: outputs.validation})[VALIDATION]
    level = nearest_level(outputs.levels)
    moving = informative_coordinates(outputs.train.positions)
    for name, method in methods.items():
        # Methods for extrapolation cannot be scored here: no row of `validation` lies there.
        if method.guarantee != MARGINAL or method.calibrated_on.is_for_extrapolation:
            continue
        for run, data in outputs.of(method.calibrated_on):
            if method.calibrated_on.is_around_a_model and run not in runs:
                continue
            with of_part(INTERVAL_METHODS, name):
                scores = held_out_scores(method, data, outputs.levels, moving, seed, outputs.validation.block)
            of_rows = scores[outputs.levels.index(level)]
            typical = typical_winkler(of_rows)
            yield {
                "model": run.model,
                "preset": run.preset,
                "interval_method": name,
                "confidence_level": level,
                DECISIVE: typical,
                "cv_winkler_mm": float(of_rows.mean()),
                "cv_winkler_without_gross_mm": float(of_rows[regular].mean()) if regular.any() else np.nan,
                "tie": typical_winkler(scores[0]) if np.isinf(typical) else 0.0,
            }


def held_out_scores(
    method: IntervalMethod[Any],
    data: Resplittable,
    levels: Sequence[float],
    moving: NDArray[np.bool_],
    seed: int,
    block: NDArray[np.int64] | None = None,
) -> Array:
    """Winkler scores (n_levels, n_rows) in mm of the calibration rows, each by the intervals that are calibrated on the
    folds without it: means over the `moving` coordinates. `block` as of `resplits`.
    """
    scores = np.empty((len(levels), len(data.truth)))
    for part, held_out in resplits(data, seed, block):
        for place, bounds in enumerate(method.intervals(part, levels)):
            winkler = winkler_scores(data.truth[held_out], bounds, levels[place])
            scores[place, held_out] = winkler[:, moving].mean(axis=1)
    return scores


def resplits(
    data: Resplittable, seed: int, block: NDArray[np.int64] | None = None
) -> Iterator[tuple[Resplittable, NDArray[np.intp]]]:
    """Calibration data on all folds of the calibration rows but one, and the held-out rows, for each fold; rows of one
    `block` (n_calibration,) stay in one fold, where there are so many.
    """
    if block is not None and len(np.unique(block)) >= N_FOLDS:
        folds = GroupKFold(N_FOLDS, shuffle=True, random_state=seed).split(data.truth, groups=block)
    else:
        folds = KFold(N_FOLDS, shuffle=True, random_state=seed).split(data.truth)
    for calibration_rows, held_out in folds:
        yield data.resplit(calibration_rows, held_out), held_out
