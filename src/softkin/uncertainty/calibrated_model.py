"""The calibrated model of a robot: positions, intervals, joint regions and p-values at any command."""

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
from softkin.core.job_records import load_model
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
    """Positions, intervals, joint regions and p-values at any commands (n_rows, n_commands), in mm.

    A run of the workflow writes one per dataset: `joblib.load("results/finger/calibrated_model.joblib")`. Coverage is
    guaranteed for commands exchangeable with those of the calibration set. In extrapolation nothing is guaranteed;
    with `shells`, intervals there are calibrated on the errors of the same model beyond cores of `train`.

    Example, on a made-up robot of two commands and one marker:

        >>> import numpy as np
        >>> from softkin.core.samples import Samples
        >>> from softkin.models import MODELS
        >>> from softkin.training.kinematic_model import FitSettings, fitted_model
        >>> from softkin.uncertainty.calibrated_model import FittedModel, calibrated
        >>> from softkin.uncertainty.intervals import INTERVAL_METHODS
        >>> commands = np.random.default_rng(0).uniform(-1, 1, (200, 2))
        >>> poses = np.column_stack([40 * commands, 100 - 5 * (commands**2).sum(axis=1)])  # x, y, z in mm
        >>> train, validation = Samples(commands[:100], poses[:100]), Samples(commands[100:], poses[100:])
        >>> estimator = fitted_model(MODELS["lr"], FitSettings({}, skip_constant=True, seed=0, threads=1), train)
        >>> model = FittedModel("bender", MODELS["lr"], "paper", estimator, train)
        >>> robot = calibrated(model, INTERVAL_METHODS["scp_crepes"], validation)
        >>> robot.predict(commands[:3]).shape  # rows, coordinates
        (3, 3)
        >>> robot.intervals(commands[:3], [0.8, 0.9]).shape  # nominal levels, rows, coordinates, lower and upper
        (2, 3, 3, 2)
        >>> lower, upper = robot.intervals(np.array([0.5, -0.5]), [0.9])[0, 0, 2]
        >>> print(f"z at this command: {lower:.1f} to {upper:.1f} mm")
        z at this command: 92.8 to 99.7 mm
    """

    dataset: str
    spec: ModelSpec
    preset: str
    method: IntervalMethod[Any]
    estimator: Any
    train: Samples
    #: Calibration data of the method, without new rows.
    known: PointCalibration
    #: Typical error (n_moving,) of each moving coordinate on `train`, mm.
    scale: Array
    #: The same model refitted on cores of `train`; none: intervals in extrapolation are as in-domain.
    shells: Sequence[Shell] = ()
    #: Command norm, (n_rows, n_commands) -> (n_rows,).
    norm: Callable[[Array], Array] | None = None

    def predict(self, commands: Array) -> Array:
        """Predicted positions (n_rows, n_coordinates)."""
        return np.asarray(self.estimator.predict(self._checked(commands)))

    def intervals(self, commands: Array, confidence_levels: Sequence[float]) -> Array:
        """Intervals (n_levels, n_rows, n_coordinates, 2) of each coordinate; levels ascending.

        In-domain they are those of the deployed method. In extrapolation, given shells, they are never narrower than
        those of split conformal prediction, nor than those of the deployed method if it is calibrated on a spread.
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
        """Which commands (n_rows,) lie in extrapolation, where nothing is guaranteed."""
        commands = self._checked(commands)
        norm = self.norm or command_norm(self.train.commands, standardised=True).of
        known = replace(self.known, new_commands=commands)
        return in_domain_and_extrapolation.is_in_extrapolation(ShellCalibration(known, self.shells, norm))

    def box(self, confidence_level: float) -> Array:
        """Half-widths (n_coordinates,) in mm of the joint box around a predicted pose that holds all moving
        coordinates at once; 0 for constant coordinates.
        """
        half = np.zeros(self.known.truth.shape[1])
        half[self._moving()] = self.scale * conformal_limit(self._scores(self._residuals()), confidence_level)
        return half

    def p_values(
        self, commands: Array, positions: Array, *, rng: np.random.Generator | None = None
    ) -> tuple[Array, Array]:
        """p-values of measured `positions` (n_rows, n_coordinates): of each coordinate (n_rows, n_coordinates) and of
        the whole pose (n_rows,).

        The paper's Eq. 4; with `rng` smoothed. Calling a pose anomalous when its p-value is at most alpha raises a
        false alarm in at most a share alpha of cases.
        """
        known, new = self._residuals(), positions - self.predict(commands)
        single = p_values(np.abs(known), np.abs(new), rng=rng)
        return single, p_values(self._scores(known), self._scores(new), rng=rng)

    def _residuals(self) -> Array:
        """Residuals (n_calibration, n_coordinates) of the calibration set, mm."""
        return self.known.truth - self.known.calibration

    def _scores(self, residuals: Array) -> Array:
        """Nonconformity of each pose (n_rows,)."""
        return joint_scores(residuals[:, self._moving()], self.scale)

    def _moving(self) -> NDArray[np.bool_]:
        return informative_coordinates(self.train.positions)

    def _checked(self, commands: Array) -> Array:
        rows = np.atleast_2d(np.asarray(commands, dtype=np.float64))
        n_commands = self.train.commands.shape[1]
        if rows.ndim != 2 or rows.shape[1] != n_commands or not np.isfinite(rows).all():
            raise DataError(
                f"expected finite commands of shape (n_rows, {n_commands}), got {rows.shape}",
                where=self.dataset,
                fix=f"pass one row of {n_commands} finite numbers per pose",
            )
        return rows


@dataclass(frozen=True, slots=True)
class FittedModel:
    """A fitted point model: its entry in the registry, preset, estimator, and the rows of `train`."""

    dataset: str
    spec: ModelSpec
    preset: str
    estimator: Any
    train: Samples

    def spread(self, commands: Array) -> Array:
        """Spread of the model at commands (n_rows, n_commands): (n_rows, n_coordinates) in mm."""
        return spread_of(self.spec, self.estimator, self.train, commands)


def calibrated(
    model: FittedModel,
    method: IntervalMethod[Any],
    validation: Samples,
    shells: Sequence[Shell] = (),
    norm: Callable[[Array], Array] | None = None,
) -> CalibratedModel:
    """The calibrated model around a fitted model, with its predictions on `train` and `validation` stored.

    Parameters:
        model: the fitted point model.
        method: an interval method around a point model; its kind of calibration data decides whether spreads are used.
        validation: the calibration set.
        shells: what the same model predicts beyond cores of `train`, the smallest core first.
        norm: command norm, (n_rows, n_commands) -> (n_rows,), that goes with the shells.
    """
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
    """Write the calibrated model that a `choice` deploys.

    Parameters:
        table: the tidy table, of which `train` and `validation` are read.
        dataset: its name.
        choice: the candidates of `choose` (CSV).
        specs: entries of the registry by model.
        methods: interval methods by name.
        models: run -> file of the fitted estimator (joblib).
        shells: the file of the rule `refit_shells`, if there is one.
        output: the calibrated model (joblib).

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
        FittedModel(dataset, specs[run.model], run.preset, load_model(models[run]), train),
        methods[best["interval_method"]],
        read_subset(table, VALIDATION),
        **extrapolation,
    )
    with replacing(output) as temporary:
        joblib.dump(robot, temporary, compress=3)
