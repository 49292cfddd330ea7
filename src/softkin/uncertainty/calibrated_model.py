"""The calibrated model of a robot: positions, intervals, joint regions and p-values at any command."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array, Samples, coordinate_columns, informative_coordinates
from softkin.core.shells import command_norm
from softkin.models.spec import ModelSpec
from softkin.training.predict import spread_of
from softkin.uncertainty.alarm import Watch
from softkin.uncertainty.calibration_data import PointCalibration, Shell, ShellCalibration, SpreadCalibration
from softkin.uncertainty.conformal import around, conformal_limit, error_scale, joint_scores, p_values
from softkin.uncertainty.control_loop import State, checked_rows
from softkin.uncertainty.intervals import in_domain_and_extrapolation
from softkin.uncertainty.intervals.spec import IntervalMethod
from softkin.uncertainty.new_session import widened, zero_spread
from softkin.uncertainty.recalibration import Recalibration, recalibration


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
    #: What a few labelled poses of a new session changed.
    recalibration: Recalibration | None = None

    def predict(self, commands: Array) -> Array:
        """Predicted positions (n_rows, n_coordinates).

        A robot that remembers is taken to be sent each command from rest, in a session never seen: `follow` takes a
        sequence, `start` a control loop. Rows may also be `Samples.inputs` of a recording.
        """
        predicted = np.asarray(self.estimator.predict(self._checked(commands)))
        return predicted if self.recalibration is None else predicted + self.recalibration.zero

    def follow(self, commands: Array, session: int | None = None) -> Array:
        """Predicted positions (n_rows, n_coordinates) of commands sent one after the other, from rest."""
        return self.predict(State(self, session).inputs(self._checked(commands)))

    def start(self, session: int | None = None, confidence_level: float = 0.9) -> State:
        """The state of the robot at rest: `state.step(command)` gives position, lower and upper bound in a loop."""
        return State(self, session, confidence_level)

    def recalibrate(self, commands: Array, positions: Array) -> CalibratedModel:
        """The calibrated model of a new session, of 1 to 50 labelled poses: commands in the order in which they were
        sent since it began (or `Samples.inputs`), positions (n_rows, n_coordinates) in mm. Its `recalibration.card()`
        says what changed.

        Raises:
            DataError: a number of poses that is not taken, poses in extrapolation, or poses that contradict each other.
        """
        inputs = self._checked(commands)
        if inputs.shape[1] == self.train.commands.shape[1]:
            inputs = State(self).inputs(inputs)
        outside = self.is_outside(inputs)
        if outside.any():
            raise DataError(
                f"{int(outside.sum())} of {len(inputs)} commands lie in extrapolation, where errors are larger",
                where=f"{self.dataset}, pose {int(np.argmax(outside))}",
                fix="label poses at commands like those of `train`",
            )
        bare = replace(self, recalibration=None)
        errors = np.atleast_2d(np.asarray(positions, dtype=np.float64)) - bare.predict(inputs)
        spread = zero_spread(self.estimator)
        found = recalibration(bare._residuals(), errors, self._moving(), spread, self.dataset)
        return replace(self, recalibration=found)

    def watch(self, rate: float = 0.01, session: int | None = None, seed: int = 0) -> Watch:
        """An alarm fed pose by pose, from rest: `watch.see(command, position)`."""
        state, names = State(self, session), coordinate_columns(self.known.truth.shape[1] // 3)
        moving = self._moving()
        return Watch(
            self._residuals()[:, moving],
            [name for name, moves in zip(names, moving, strict=True) if moves],
            rate,
            seed,
            lambda command, position: (position - self.predict(state.inputs(command[None]))[0])[moving],
        )

    def intervals(self, commands: Array, confidence_levels: Sequence[float], predicted: Array | None = None) -> Array:
        """Intervals (n_levels, n_rows, n_coordinates, 2) of each coordinate; levels ascending. `predicted` is what
        `predict` says of the commands, where it is known.

        In-domain they are those of the deployed method. In extrapolation, given shells, they are never narrower than
        those of split conformal prediction, nor than those of the deployed method if it is calibrated on a spread.
        """
        inputs = self._checked(commands)
        data = replace(
            self.known,
            new=self.predict(inputs) if predicted is None else predicted,
            new_commands=self._commands(inputs),
        )
        if self.recalibration is not None:
            halves = self.recalibration.half_widths(self._residuals(), confidence_levels)
            bounds = around(data.new[None], halves)
        else:
            if isinstance(data, SpreadCalibration):
                data = replace(data, new_spread=spread_of(self.spec, self.estimator, self.train, inputs))
            bounds = self.method.intervals(data, confidence_levels)
            bounds = widened(bounds, data.new, self.estimator, inputs, confidence_levels)
        if self.norm is None:
            return bounds
        shells = ShellCalibration(data, self.shells, self.norm, bounds, self.method.calibrated_on.has_spread)
        return in_domain_and_extrapolation.intervals(shells, confidence_levels)

    def is_outside(self, commands: Array) -> NDArray[np.bool_]:
        """Which commands (n_rows,) lie in extrapolation, where nothing is guaranteed."""
        commands = self._commands(self._checked(commands))
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

    def _commands(self, inputs: Array) -> Array:
        return inputs[:, : self.train.commands.shape[1]]

    def _scores(self, residuals: Array) -> Array:
        """Nonconformity of each pose (n_rows,)."""
        return joint_scores(residuals[:, self._moving()], self.scale)

    def _moving(self) -> NDArray[np.bool_]:
        return informative_coordinates(self.train.positions)

    def _checked(self, commands: Array) -> Array:
        return checked_rows(commands, self.train, self.dataset)


@dataclass(frozen=True, slots=True)
class FittedModel:
    """A fitted point model: its entry in the registry, preset, estimator, and the rows of `train`."""

    dataset: str
    spec: ModelSpec
    preset: str
    estimator: Any
    train: Samples

    def spread(self, inputs: Array) -> Array:
        """Spread of the model at inputs (n_rows, n_inputs): (n_rows, n_coordinates) in mm."""
        return spread_of(self.spec, self.estimator, self.train, inputs)


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
    predicted = np.asarray(model.estimator.predict(validation.inputs))
    known: dict[str, Array] = {
        "calibration": predicted,
        "truth": validation.positions,
        "new": predicted[:0],
        "train_commands": train.commands,
        "calibration_commands": validation.commands,
        "new_commands": validation.commands[:0],
    }
    if method.calibrated_on.has_spread:
        known["train_spread"] = model.spread(train.inputs)
        known["calibration_spread"] = model.spread(validation.inputs)
        known["new_spread"] = known["calibration_spread"][:0]
    errors = np.abs(train.positions - model.estimator.predict(train.inputs))
    scale = error_scale(errors[:, informative_coordinates(train.positions)])
    data = method.calibrated_on(**known)
    return CalibratedModel(
        model.dataset, model.spec, model.preset, method, model.estimator, train, data, scale, shells, norm
    )
