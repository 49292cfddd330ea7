"""The calibrated model of a robot: positions, intervals, joint regions and p-values at any command."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from softkin.core.samples import Array, Samples, informative_coordinates
from softkin.models.spec import PointModel
from softkin.uncertainty import calls, chance_and_time
from softkin.uncertainty.alarm import Watch
from softkin.uncertainty.answers import bounds_frame, like
from softkin.uncertainty.calibration_data import PointCalibration, Shell
from softkin.uncertainty.conformal import conformal_limit, joint_scores, p_values
from softkin.uncertainty.control_loop import State, error_of
from softkin.uncertainty.described import described
from softkin.uncertainty.failures import FailureClass
from softkin.uncertainty.file_format import restore, stored_state
from softkin.uncertainty.intervals.spec import IntervalMethod
from softkin.uncertainty.inverse import Inverse
from softkin.uncertainty.joint_intervals import JointAnswers, JointIntervals
from softkin.uncertainty.joint_region import JointRegion
from softkin.uncertainty.new_session import labelled_errors, zero_spread
from softkin.uncertainty.orientations import Orientations
from softkin.uncertainty.prepared import Prepared
from softkin.uncertainty.promise import asked_levels, own_rows
from softkin.uncertainty.recalibration import Recalibration, recalibration
from softkin.uncertainty.suggestions import Suggestions


@dataclass(frozen=True, repr=False)
class CalibratedModel(Inverse, Orientations, Suggestions):
    """Positions, intervals, joint regions and p-values at any commands (n_rows, n_commands), in mm or `names.unit`.

    Commands may be an array, lists, one row, or a DataFrame by the robot's own names, which DataFrames answer. A run
    writes one per dataset: `softkin.load("results/finger/calibrated_model.joblib")`. Coverage is guaranteed for
    commands exchangeable with those of the calibration set. In extrapolation nothing is; with `shells`, intervals there
    are calibrated on the errors of the same model beyond cores of `train`.

    Example, on a made-up robot of two commands and one marker:

        >>> import numpy as np
        >>> from softkin.core.samples import Samples
        >>> from softkin.models import MODELS
        >>> from softkin.training.kinematic_model import FitSettings, fitted_model
        >>> from softkin.uncertainty.calibrated import FittedModel, calibrated
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
        >>> robot.intervals([0.5, -0.5], 0.9)[0, 2].round(1)  # lower and upper bound of z in mm
        array([92.8, 99.7])
    """

    dataset: str
    spec: PointModel
    preset: str
    method: IntervalMethod[Any]
    estimator: Any
    train: Samples
    #: Calibration data of the method, without new rows.
    known: PointCalibration
    #: Typical error (n_moving,) of each moving coordinate on `train`, mm.
    scale: Array
    #: The region that holds a whole pose.
    joint: JointRegion
    #: The same model refitted on cores of `train`; none: intervals in extrapolation are as in-domain.
    shells: Sequence[Shell] = ()
    #: Command norm, (n_rows, n_commands) -> (n_rows,).
    norm: Callable[[Array], Array] | None = None
    #: What a few labelled poses of a new session changed.
    recalibration: Recalibration | None = None
    #: What `train` tells of poses that fail; None: it shows none that commands foretell.
    failures: FailureClass | None = None
    #: Else known: `data`, the hash of `train`; `columns`, its own names; `unit`, if not mm; `date`; `orientation`.
    about: Mapping[str, Any] = field(default_factory=dict)

    def predict(self, commands: calls.Rows) -> Array | pd.DataFrame:
        """Predicted positions (n_rows, n_coordinates).

        A robot that remembers is taken to be sent each command from rest, in a session never seen: `follow` takes a
        sequence, `start` a control loop. calls.Rows may also be `Samples.inputs` of a recording.
        """
        return like(commands, self._predicted(self._checked(commands)), self.names.coordinates)

    def follow(self, commands: calls.Rows, session: int | None = None) -> Array | pd.DataFrame:
        """Predicted positions (n_rows, n_coordinates) of commands sent one after the other, from rest."""
        inputs = State(self, session).inputs(commands)
        return like(commands, self._predicted(inputs), self.names.coordinates)

    def start(self, session: int | None = None, confidence_level: float = 0.9) -> State:
        """The state of the robot at rest: `state.step(command)` gives position, lower and upper bound in a loop."""
        level = calls.level_of(confidence_level, self.dataset)
        self._prepared.make_ready((level,))
        return State(self, session, level)

    def recalibrate(self, commands: calls.Rows, positions: calls.Rows) -> CalibratedModel:
        """The calibrated model of a new session, of 1 to 50 labelled poses: commands in the order in which they were
        sent since it began (or `Samples.inputs`), positions (n_rows, n_coordinates) in mm. Its `recalibration.card()`
        says what changed.

        Raises:
            DataError: a number of poses that is not taken, poses in extrapolation, or poses that contradict each other.
        """
        errors, spread = labelled_errors(self, commands, positions), zero_spread(self.estimator)
        found = recalibration(self._residuals(), errors, self._moving(), spread, self.dataset, self.names.unit)
        return replace(self, recalibration=found)

    def watch(self, rate: float = 0.01, session: int | None = None, seed: int = 0) -> Watch:
        """An alarm fed pose by pose, from rest: `watch.see(command, position)`; `watch.worth`: is its rate promised?"""
        rate = chance_and_time.rate_of(rate, seed, self.dataset)
        moving = self._moving()
        moves = [name for name, moves in zip(self.names.coordinates, moving, strict=True) if moves]
        error = error_of(State(self, session), moving)
        return Watch(self._residuals()[:, moving], moves, rate, seed, error, self.joint.promise)

    def intervals(
        self, commands: calls.Rows, confidence_levels: float | Sequence[float] | Array, predicted: Array | None = None
    ) -> Array | pd.DataFrame:
        """Intervals of each coordinate, (n_levels, n_rows, n_coordinates, 2), levels in the order given; of one number
        (n_rows, n_coordinates, 2). A DataFrame has columns lower_m1_x, upper_m1_x, ..., of several levels below each
        level. `predicted` is what `predict` says of the commands, where it is known.

        In-domain they are those of the deployed method. In extrapolation, given shells, they are never narrower than
        those of split conformal prediction, nor than those of the deployed method if it is calibrated on a spread.
        """
        inputs, (levels, is_one) = self._checked(commands), calls.levels_of(confidence_levels, self.dataset)
        if predicted is not None:
            predicted = calls.position_rows(predicted, self.names, len(inputs), f"{self.dataset}, predicted")
        ascending = sorted(set(levels))
        bounds = self._bounds(inputs, ascending, self._predicted(inputs) if predicted is None else predicted)
        if levels != ascending:
            bounds = bounds[[ascending.index(level) for level in levels]]
        if isinstance(commands, (pd.DataFrame, pd.Series)):
            return bounds_frame(commands, bounds, None if is_one else levels, self.names.coordinates)
        return bounds[0] if is_one else bounds

    def joint_intervals(
        self, commands: calls.Rows, confidence_levels: float | Sequence[float] | Array
    ) -> JointIntervals:
        """Regions that each hold a whole pose, all moving coordinates at once: `bounds` as of `intervals`, `matrices`
        of ellipsoids, `contains(positions)`. In-domain of one size, exactly calibrated; given shells they grow outside.
        """
        return self._joint.intervals(commands, confidence_levels)

    def is_outside(self, commands: calls.Rows) -> NDArray[np.bool_] | pd.Series:
        """Which commands (n_rows,) lie in extrapolation, where nothing is guaranteed."""
        rows = self._commands(self._checked(commands))
        return like(commands, self._prepared.is_outside(rows), "outside")

    def failure_probability(self, commands: calls.Rows) -> Array | pd.Series | None:
        """Probability (n_rows,) that the pose fails; None where `train` shows no failures that commands foretell. Where
        it exceeds 1 - level (and their share of `train`) intervals hold the failed poses of `train`, too.
        """
        rows = self._commands(self._checked(commands))
        return None if self.failures is None else like(commands, self.failures.probability(rows), "failure_probability")

    def box(self, confidence_level: float) -> Array:
        """Half-widths (n_coordinates,) in mm of the joint box around a predicted pose that holds all moving
        coordinates at once; 0 for constant coordinates.
        """
        half = np.zeros(self.known.truth.shape[1])
        (level,) = asked_levels(self.joint.promise, [calls.level_of(confidence_level, self.dataset)])
        half[self._moving()] = self.scale * conformal_limit(self._scores(self._residuals()), level)
        return half

    def p_values(
        self, commands: calls.Rows, positions: calls.Rows, *, rng: np.random.Generator | None = None
    ) -> tuple[Array | pd.DataFrame, Array | pd.Series]:
        """p-values of measured `positions` (n_rows, n_coordinates) in mm: of each coordinate (n_rows, n_coordinates)
        and of the whole pose (n_rows,). In a DataFrame, positions by the robot's own names are in its own unit.

        The paper's Eq. 4; with `rng` smoothed. Calling a pose anomalous when its p-value is at most alpha raises a
        false alarm in at most a share alpha of cases. Where blocks are exchangeable and not rows, p-values count blocks
        and that holds for a pose of a new block; with too few for 90 % they count rows, and nothing is promised.
        """
        inputs = self._checked(commands)
        chance_and_time.check_generator(rng, self.dataset)
        calls.check_same_rows(commands, positions, self.dataset)
        measured = calls.position_rows(positions, self.names, len(inputs), self.dataset)
        known, new = self._residuals(), measured - self._predicted(inputs)
        own = own_rows(self.joint.promise)
        single = p_values(np.abs(known), np.abs(new), rng=rng, own=own)
        joint = p_values(self._scores(known), self._scores(new), rng=rng, own=own)
        return like(commands, single, self.names.coordinates), like(commands, joint, "pose")

    def __repr__(self) -> str:
        return described(self)

    def __getstate__(self) -> dict[str, Any]:
        return stored_state(self)

    def __setstate__(self, state: Any) -> None:
        restore(self, state)

    def _predicted(self, inputs: Array) -> Array:
        """Positions (n_rows, n_coordinates) of inputs that are checked."""
        return self._prepared.predicted(inputs)

    def _bounds(self, inputs: Array, levels: Sequence[float], predicted: Array) -> Array:
        """Intervals (n_levels, n_rows, n_coordinates, 2) at ascending levels."""
        bounds = self._prepared.bounds(inputs, tuple(levels), predicted)
        return bounds if self.failures is None else self.failures.widened(bounds, self._commands(inputs), levels)

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

    def _checked(self, commands: calls.Rows) -> Array:
        return calls.command_rows(commands, self.names, self._n_inputs, self.dataset)

    @cached_property
    def _n_inputs(self) -> int:
        return int(self.train.inputs.shape[1])

    @cached_property
    def _prepared(self) -> Prepared:
        return Prepared(self)

    @cached_property
    def _joint(self) -> JointAnswers:
        return JointAnswers(self)

    @cached_property
    def names(self) -> calls.Names:
        """What its columns are called."""
        return calls.Names.of(self.train.commands.shape[1], self.known.truth.shape[1], self.about)
