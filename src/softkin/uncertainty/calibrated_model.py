"""The chosen model of a robot with its calibration set: where is it, how sure is that, and can it be there at all?"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import joblib
import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import ConfigError, DataError
from softkin.core.files import replacing
from softkin.core.run_archive import read_run_archive
from softkin.core.runs import Run
from softkin.core.samples import TRAIN, VALIDATION, Array, Samples, informative_coordinates
from softkin.core.shells import command_norm
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.training.predict import spread_of
from softkin.uncertainty.calibration_data import PointCalibration, Shell, ShellCalibration, SpreadCalibration
from softkin.uncertainty.choose import deployed_choice
from softkin.uncertainty.conformal import conformal_limit, error_scale, joint_scores, p_values
from softkin.uncertainty.intervals import in_domain_and_extrapolation
from softkin.uncertainty.intervals.spec import AUTO, IntervalMethod
from softkin.uncertainty.stored_outputs import norm_of, shells_of


@dataclass(frozen=True, slots=True)
class CalibratedModel:
    """Positions, intervals, regions and p-values at any commands (n_rows, n_commands), in mm.

    `joblib.load("results/finger/calibrated_model.joblib")` gives one. What it promises holds for commands like those
    it was calibrated with; outside the range of `train` nothing is promised, and where the model was fitted on cores of
    `train` too (`shells`), intervals there are made from what it got wrong around them.
    """

    dataset: str
    spec: ModelSpec
    preset: str
    method: IntervalMethod[Any]
    estimator: Any
    train: Samples
    #: What the method sees at any commands: `train` and `validation`, without new rows.
    known: PointCalibration
    #: Typical error (n_moving,) of each moving coordinate on `train`, mm.
    scale: Array
    #: The same model fitted on cores of `train`; none: intervals outside are as those inside.
    shells: Sequence[Shell] = ()
    #: How far out commands lie.
    norm: Callable[[Array], Array] | None = None

    def predict(self, commands: Array) -> Array:
        """Predicted positions (n_rows, n_coordinates)."""
        return np.asarray(self.estimator.predict(self._checked(commands)))

    def intervals(self, commands: Array, confidence_levels: Sequence[float]) -> Array:
        """Intervals (n_levels, n_rows, n_coordinates, 2) of each coordinate; levels ascending. By the chosen method
        inside the training region, and outside it never narrower than split conformal prediction's, nor, where that
        tells how unsure the model is, than the chosen method's.
        """
        commands = self._checked(commands)
        data = replace(self.known, new=self.predict(commands), new_commands=commands)
        if isinstance(data, SpreadCalibration):
            data = replace(data, new_spread=spread_of(self.spec, self.estimator, self.train, commands))
        bounds = self.method.intervals(data, confidence_levels)
        if self.norm is None:
            return bounds
        shells = ShellCalibration(data, self.shells, self.norm, bounds, self.method.calibrated_on.has_spread)
        return in_domain_and_extrapolation.intervals(shells, confidence_levels)

    def is_outside(self, commands: Array) -> NDArray[np.bool_]:
        """Which commands (n_rows,) lie outside the training region, where nothing is promised."""
        commands = self._checked(commands)
        norm = self.norm or command_norm(self.train.commands, standardised=True).of
        known = replace(self.known, new_commands=commands)
        return in_domain_and_extrapolation.is_in_extrapolation(ShellCalibration(known, self.shells, norm))

    def box(self, confidence_level: float) -> Array:
        """Half-widths (n_coordinates,) in mm of a box around a predicted pose that holds all moving coordinates at
        once; those that never move have none.
        """
        half = np.zeros(self.known.truth.shape[1])
        half[self._moving()] = self.scale * conformal_limit(self._scores(self._residuals()), confidence_level)
        return half

    def p_values(
        self, commands: Array, positions: Array, *, rng: np.random.Generator | None = None
    ) -> tuple[Array, Array]:
        """How well measured `positions` (n_rows, n_coordinates) agree with the model: p-values of each coordinate
        (n_rows, n_coordinates) and of the whole pose (n_rows,).

        The paper's Eq. 4; with `rng` smoothed. Calling a pose anomalous when its p-value is at most alpha raises a
        false alarm in at most a share alpha of cases.
        """
        known, new = self._residuals(), positions - self.predict(commands)
        single = p_values(np.abs(known), np.abs(new), rng=rng)
        return single, p_values(self._scores(known), self._scores(new), rng=rng)

    def _residuals(self) -> Array:
        """Of the calibration set."""
        return self.known.truth - self.known.calibration

    def _scores(self, residuals: Array) -> Array:
        """Nonconformity of each pose (n_rows,)."""
        return joint_scores(residuals[:, self._moving()], self.scale)

    def _moving(self) -> Any:
        return informative_coordinates(self.train.positions)

    def _checked(self, commands: Array) -> Array:
        rows = np.atleast_2d(np.asarray(commands, dtype=np.float64))
        wanted = self.train.commands.shape[1]
        if rows.ndim != 2 or rows.shape[1] != wanted or not np.isfinite(rows).all():
            raise DataError(
                f"expected finite commands of shape (n_rows, {wanted}), got {rows.shape}",
                where=self.dataset,
                fix=f"pass one row of {wanted} finite numbers per pose",
            )
        return rows


@dataclass(frozen=True, slots=True)
class FittedModel:
    """A model of a dataset as it was fitted: its entry in the registry, preset, fitted estimator and the rows of
    `train`.
    """

    dataset: str
    spec: ModelSpec
    preset: str
    estimator: Any
    train: Samples

    def spread(self, commands: Array) -> Array:
        """What the model says of its own uncertainty: (n_rows, n_coordinates) in mm."""
        return spread_of(self.spec, self.estimator, self.train, commands)


def calibrated(
    model: FittedModel,
    method: IntervalMethod[Any],
    validation: Samples,
    shells: Sequence[Shell] = (),
    norm: Callable[[Array], Array] | None = None,
) -> CalibratedModel:
    """A fitted model with all that never changes worked out: its predictions of `train` and of `validation`."""
    train = model.train
    predicted = np.asarray(model.estimator.predict(validation.commands))
    known: dict[str, Array] = {
        "calibration": predicted,
        "truth": validation.positions,
        "new": predicted[:0],
        "train_commands": train.commands,
        "calibration_commands": validation.commands,
        "new_commands": validation.commands[:0],
    }
    if method.calibrated_on.has_spread:
        known["train_spread"] = model.spread(train.commands)
        known["calibration_spread"] = model.spread(validation.commands)
        known["new_spread"] = known["calibration_spread"][:0]
    errors = np.abs(train.positions - model.estimator.predict(train.commands))
    scale = error_scale(errors[:, informative_coordinates(train.positions)])
    data = method.calibrated_on(**known)
    return CalibratedModel(
        model.dataset, model.spec, model.preset, method, model.estimator, train, data, scale, shells, norm
    )


def build_calibrated_model(
    table: str | Path,
    *,
    dataset: str,
    choice: str | Path,
    specs: Mapping[str, ModelSpec],
    methods: Mapping[str, IntervalMethod[Any]],
    models: Mapping[Run, str | Path],
    shells: str | Path | None,
    output: str | Path,
) -> None:
    """Write the calibrated model (joblib): what the `choice` deploys, around one of `models`.

    `models` is run -> fitted model, `shells` the file of `refit_shells`, if there is one.

    Raises:
        ConfigError: no configured method puts an interval around a model.
    """
    best = deployed_choice(choice)
    if best is None:
        raise ConfigError(
            "no configured method puts an interval around a model",
            where=dataset,
            fix="add scp_mapie to interval_methods",
        )
    run, train = Run(best["model"], best["preset"]), read_subset(table, TRAIN)
    extrapolation: dict[str, Any] = {}
    if best["outside"] == AUTO:
        archive = read_run_archive(shells)
        extrapolation = {"shells": shells_of(archive, train)[run], "norm": norm_of(archive)}
    robot = calibrated(
        FittedModel(dataset, specs[run.model], run.preset, joblib.load(models[run]), train),
        methods[best["interval_method"]],
        read_subset(table, VALIDATION),
        **extrapolation,
    )
    with replacing(output) as temporary:
        joblib.dump(robot, temporary, compress=3)
