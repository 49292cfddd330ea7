"""Regressor of recorded rows: features of memory in front of any kinematic regressor, and a zero for each session."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, RegressorMixin, clone
from sklearn.preprocessing import PolynomialFeatures

from softkin.core.recording import Array, CommandMemory
from softkin.core.smooth_fit import degree_for
from softkin.models.estimators.memory_features import NONE, PLAY, MemoryFeatures

#: No session of the recording: the average zero.
UNSEEN = 0.0
#: Zeros are estimated again without rows so many robust standard deviations off, unless fewer than this share are left.
REFITS, FAR_SCALES, LEAST_KEPT = 3, 8.0, 0.5


class InSessions(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """Inputs (command, memory, session) -> positions in mm.

    A session shifts all poses by its zero, and is no input of `regressor`: as one it would make sessions never seen
    worse. Zeros are estimated beside a polynomial of the commands, shrunk towards their mean by how uncertain they are,
    and average to none, so that a session never seen gets the average zero.

    Bare commands are taken as sent one by one to a robot at rest, in no session of the recording.

    Parameters:
        regressor: kinematic regressor of features.
        robot: how memory is computed from commands.
        memory, widths: see `MemoryFeatures`.
        zeros: whether sessions have zeros.
    """

    def __init__(
        self, regressor: Any, robot: CommandMemory, memory: str = NONE, widths: str = "fine", zeros: bool = True
    ) -> None:
        self.regressor = regressor
        self.robot = robot
        self.memory = memory
        self.widths = widths
        self.zeros = zeros

    def fit(self, X: Array, y: Array) -> Self:
        """Fit on inputs X (n_rows, n_inputs) and positions y (n_rows, n_coordinates) in mm."""
        n_commands = len(self.robot.rest)
        self.features_ = MemoryFeatures(n_commands, self.memory, self.widths)
        self.sessions_, codes = np.unique(X[:, -1], return_inverse=True)
        self.zeros_ = np.zeros((len(self.sessions_), y.shape[1]))
        if self.zeros and len(self.sessions_) > 1:
            self.zeros_ = session_zeros(MemoryFeatures(n_commands, PLAY, "fine").transform(X), y, codes, n_commands)
        self.model_ = clone(self.regressor).set_params(n_commands=n_commands)
        self.model_.fit(self.features_.transform(X), y - self.zeros_[codes])
        return self

    def predict(self, X: Array) -> Array:
        """Positions (n_rows, n_coordinates) in mm at inputs, or at bare commands."""
        inputs = self.inputs(X)
        return np.asarray(self.model_.predict(self.features_.transform(inputs)) + self.zeros_of(inputs[:, -1]))

    def inputs(self, X: Array) -> Array:
        """Inputs of X, which may be bare commands (n_rows, n_commands), each sent to a robot at rest."""
        n_commands = self.features_.n_commands
        if X.shape[1] != n_commands:
            return X
        return np.column_stack([X, self.robot.from_rest(X), np.full(len(X), UNSEEN)])

    def zeros_of(self, session: Array) -> Array:
        """Zeros (n_rows, n_coordinates) in mm of sessions (n_rows,); 0 for one that is not in the recording."""
        places = np.searchsorted(self.sessions_, session).clip(max=len(self.sessions_) - 1)
        return np.where((self.sessions_[places] == session)[:, None], self.zeros_[places], 0.0)

    def resolved(self, X: Array) -> tuple[Any, Array, Array]:
        """The kinematic regressor inside, what it is given of X, and the zeros (n_rows, n_coordinates) added to it."""
        inputs = self.inputs(X)
        return self.model_, self.features_.transform(inputs), self.zeros_of(inputs[:, -1])


def session_zeros(features: Array, positions: Array, codes: Any, n_commands: int) -> Array:
    """Zeros (n_sessions, n_coordinates) in mm of sessions, shrunk; their mean is 0.

    Least squares of a polynomial of the commands, linear terms of memory and a constant for each session, refitted
    without gross errors; of each session then the median of what the rest leaves. Shrunk as random effects
    (DerSimonian and Laird 1986): less certain zeros lie nearer to the mean.

    Parameters:
        features: (n_rows, n_features), the commands first.
        positions: (n_rows, n_coordinates) in mm.
        codes: session (n_rows,) of each row, from 0.
        n_commands: how many of the features are commands.
    """
    centre, half = (features.max(axis=0) + features.min(axis=0)) / 2, np.ptp(features, axis=0) / 2
    scaled = (features - centre) / np.where(half > 0, half, 1.0)
    terms = PolynomialFeatures(max(1, degree_for(len(features), n_commands)), include_bias=False)
    n_sessions = int(codes.max()) + 1
    smooth = np.hstack([terms.fit_transform(scaled[:, :n_commands]), scaled[:, n_commands:]])
    design = np.hstack([smooth, np.eye(n_sessions)[codes]])
    kept = np.ones(len(design), dtype=bool)
    for _ in range(REFITS):
        coefficients = np.linalg.lstsq(design[kept], positions[kept], rcond=None)[0]
        errors = np.abs(positions - design @ coefficients)
        near = errors <= FAR_SCALES * 1.4826 * np.median(errors[kept], axis=0) + np.finfo(float).tiny
        kept = near.all(axis=1) if near.all(axis=1).mean() > LEAST_KEPT else kept
    left = positions - smooth @ coefficients[: smooth.shape[1]]
    raw = np.stack([np.median(left[codes == place], axis=0) for place in range(n_sessions)])
    counts = np.bincount(codes)[:, None]
    uncertain = np.square(1.4826 * np.median(np.abs(left - raw[codes]), axis=0)) * (np.pi / 2) / counts
    between = np.maximum(0.0, raw.var(axis=0, ddof=1) - uncertain.mean(axis=0))
    weights = 1 / np.maximum(between + uncertain, np.finfo(float).tiny)
    mean = (weights * raw).sum(axis=0) / weights.sum(axis=0)
    shares = np.divide(between, between + uncertain, out=np.zeros_like(raw), where=between + uncertain > 0)
    shrunk = shares * (raw - mean)
    return np.asarray(shrunk - shrunk.mean(axis=0))
