"""Regressor from commands to positions, built and fitted the same way in every stage."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sklearn.exceptions import ConvergenceWarning
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from softkin.core.clocks import counted_as_fit
from softkin.core.recording import Recording
from softkin.core.samples import Params, Samples
from softkin.core.threads import limited_threads
from softkin.models.estimators.in_sessions import InSessions
from softkin.models.estimators.kinematic_regressor import KinematicRegressor
from softkin.models.estimators.memory_features import NONE
from softkin.models.spec import ModelSpec
from softkin.models.target_spaces import TARGET_SPACES

logger = logging.getLogger("softkin")


@dataclass(frozen=True, slots=True)
class FitSettings:
    """How a model is fitted.

    `params` are the model's own; `skip_constant` leaves coordinates that never vary out of the fit; `base` is the
    robot's base as the dataset's entry declares it, for a target space that needs it. On recorded rows, `memory` says
    what the model is told of the commands before: `memory`, `widths` and `zeros` of `InSessions`; None: nothing.
    """

    params: Params
    skip_constant: bool
    seed: int
    threads: int
    target_space: str = "cartesian"
    base: Mapping[str, Any] | None = None
    memory: Mapping[str, Any] | None = None


def recorded_settings(record: Mapping[str, Any], seed: int, threads: int) -> FitSettings:
    """The settings of a fit `record` (as `fit` writes it): its parameters, target space and base."""
    return FitSettings(
        params=record["params"],
        skip_constant=record["skip_constant"],
        seed=seed,
        threads=threads,
        target_space=record["target_space"],
        base=record["base"],
        memory=record["memory"],
    )


def searched_settings(best: Mapping[str, Any], base: Mapping[str, Any] | None, seed: int, threads: int) -> FitSettings:
    """The settings of a fit with the `best` parameters of a study (as `tune_table` writes them)."""
    return FitSettings(
        best["params"], True, seed, threads, target_space=best["target_space"], base=base, memory=best["memory"]
    )


#: The command alone, the same in all sessions: what the paper's models are told.
STATIC = {"memory": NONE, "zeros": False}


def kinematic_model(spec: ModelSpec, settings: FitSettings, recording: Recording | None = None) -> Any:
    """Unfitted regressor of commands -> positions in mm, which standardises both by the rows that it is fitted on; of
    the inputs of recorded rows, where there is a `recording`.
    """
    regressor = KinematicRegressor(
        make_pipeline(StandardScaler(), spec.build(settings.params, settings.seed, settings.threads)),
        TARGET_SPACES[settings.target_space].transformer(settings.skip_constant, settings.base),
    )
    if recording is None:
        return regressor
    return InSessions(regressor, recording.robot, **(settings.memory or STATIC))


def fitted_model(spec: ModelSpec, settings: FitSettings, samples: Samples) -> Any:
    """The model of `settings`, fitted on `samples`."""
    estimator = kinematic_model(spec, settings, samples.recording)
    fit_quietly(estimator, samples, settings.threads)
    return estimator


def fit_quietly(estimator: Any, samples: Samples, threads: int) -> int:
    """Fit in place on at most `threads` threads; return how many solvers stopped at their iteration bound.

    The bounds are deliberate (they limit the time of a fit), so their warnings are counted, not printed.
    """
    with warnings.catch_warnings(record=True) as caught, limited_threads(threads), counted_as_fit():
        warnings.simplefilter("always")
        estimator.fit(samples.inputs, samples.positions)
    stopped = [w for w in caught if issubclass(w.category, ConvergenceWarning)]
    for message in {str(w.message) for w in caught if w not in stopped}:
        logger.warning("%s", message)
    return len(stopped)
