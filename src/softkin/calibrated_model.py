"""The chosen model of a robot with its calibration set: where is it, how sure is that, and can it be there at all?"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import joblib
import numpy as np
from numpy.typing import NDArray

from softkin.choosing_intervals import deployed_choice
from softkin.conformal import conformal_limit, error_scale, joint_scores, p_values
from softkin.datasets.table import read_subset
from softkin.evidence import norm_of, read_archive, shells_of
from softkin.files import replacing
from softkin.fitting import spread_of
from softkin.interface import (
    AUTO,
    TRAIN,
    VALIDATION,
    Array,
    Evidence,
    IntervalMethod,
    ModelSpec,
    Samples,
    Shell,
    ShellEvidence,
    SoftkinError,
    informative_coordinates,
)
from softkin.intervals import inside_and_outside
from softkin.shells import command_norm


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
    method: IntervalMethod
    estimator: Any
    train: Samples
    #: What the method sees at any commands: `train` and `validation`, without `new` rows.
    known: Evidence
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
        spreads = {}
        if self.known.calibration_spread is not None:
            spreads["new_spread"] = spread_of(self.spec, self.estimator, self.train, commands)
        evidence = replace(self.known, new=self.predict(commands), new_commands=commands, **spreads)
        bounds = self.method.intervals(evidence, confidence_levels)
        if self.norm is None:
            return bounds
        shells = ShellEvidence(evidence, self.shells, self.norm, bounds, inside_and_outside.is_informed(self.method))
        return inside_and_outside.intervals(shells, confidence_levels)

    def is_outside(self, commands: Array) -> NDArray[np.bool_]:
        """Which commands (n_rows,) lie outside the training region, where nothing is promised."""
        commands = self._checked(commands)
        norm = self.norm or command_norm(self.train.commands, standardised=True).of
        known = replace(self.known, new_commands=commands)
        return inside_and_outside.outside(ShellEvidence(known, self.shells, norm))

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
            raise SoftkinError(
                f"{self.dataset}: expected finite commands of shape (n_rows, {wanted}), got {rows.shape}"
            )
        return rows


def calibrated(
    dataset: str,
    spec: ModelSpec,
    preset: str,
    method: IntervalMethod,
    estimator: Any,
    train: Samples,
    validation: Samples,
    shells: Sequence[Shell] = (),
    norm: Callable[[Array], Array] | None = None,
) -> CalibratedModel:
    """A fitted `estimator` with all that never changes worked out: what it says of `train` and of `validation`."""
    spreads = {}
    if method.on != "predictions":
        parts = {"train_spread": train.commands, "calibration_spread": validation.commands}
        spreads = {part: spread_of(spec, estimator, train, commands) for part, commands in parts.items()}
    predicted = np.asarray(estimator.predict(validation.commands))
    known = Evidence(
        predicted,
        validation.positions,
        predicted[:0],
        train_commands=train.commands,
        calibration_commands=validation.commands,
        **spreads,
    )
    errors = np.abs(train.positions - estimator.predict(train.commands))
    scale = error_scale(errors[:, informative_coordinates(train.positions)])
    return CalibratedModel(dataset, spec, preset, method, estimator, train, known, scale, shells, norm)


def bundle(
    table: str | Path,
    *,
    dataset: str,
    choice: str | Path,
    specs: Mapping[str, ModelSpec],
    methods: Mapping[str, IntervalMethod],
    models: Mapping[tuple[str, str], str | Path],
    shells: str | Path | None,
    output: str | Path,
) -> None:
    """Write the calibrated model (joblib): what the `choice` deploys, around one of `models`.

    `models` is (model, preset) -> fitted model, `shells` the file of `refit_shells`, if there is one.
    """
    best = deployed_choice(choice)
    if best is None:
        raise SoftkinError(
            f"{dataset}: no configured method puts an interval around a model; mend: add scp_mapie to interval_methods"
        )
    run, train = (best["model"], best["preset"]), read_subset(table, TRAIN)
    beyond: dict[str, Any] = {}
    if best["outside"] == AUTO:
        archive = read_archive(shells)
        beyond = {"shells": shells_of(archive, train)[run], "norm": norm_of(archive)}
    robot = calibrated(
        dataset,
        specs[run[0]],
        run[1],
        methods[best["interval_method"]],
        joblib.load(models[run]),
        train,
        read_subset(table, VALIDATION),
        **beyond,
    )
    with replacing(output) as temporary:
        joblib.dump(robot, temporary, compress=3)
