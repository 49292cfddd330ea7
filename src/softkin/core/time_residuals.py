"""What a smooth fit of poses by commands alone leaves, in the order of a recording: where memory shows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softkin.core.recording import WIDTHS, Whole, input_parts
from softkin.core.rows import stacked_commands, stacked_positions
from softkin.core.samples import TRAIN, Array, Samples, coordinate_columns, informative_coordinates
from softkin.core.smooth_fit import fit_smoothly

#: Rows whose residual is so many robust standard deviations off are gross errors, and say nothing of time.
GROSS = 10.0
#: With fewer rows in order nothing is measured.
FEWEST_ROWS = 60


@dataclass(frozen=True, slots=True)
class TimeResiduals:
    """Measured minus smoothly fitted positions (n_rows, n_coordinates) in mm, in the order of the recording; `names` of
    the moving coordinates; `session` (n_rows,); `commands` and what the robot may remember: `step` from the previous
    command, `stops` (n_rows, n_widths * n_commands) of the play operators. `degree` of the polynomial.
    """

    residuals: Array
    names: tuple[str, ...]
    order: Whole
    session: Whole
    commands: Array
    step: Array
    stops: Array
    degree: int

    def without_zeros(self) -> Array:
        """The residuals less the mean of their session."""
        result = self.residuals.copy()
        for number in np.unique(self.session):
            rows = self.session == number
            result[rows] -= result[rows].mean(axis=0)
        return result

    def zeros(self) -> Array:
        """Mean residual (n_sessions, n_coordinates) of each session, mm."""
        return np.stack([self.residuals[self.session == number].mean(axis=0) for number in np.unique(self.session)])

    def pairs(self) -> NDArray[np.intp]:
        """Rows whose next row follows in the same session."""
        return np.flatnonzero(np.diff(self.session) == 0)


def time_residuals(samples: Mapping[str, Samples]) -> TimeResiduals | None:
    """The residuals of a recording, of all subsets; None without one, or with too few rows."""
    recordings = [rows.recording for rows in samples.values()]
    known = [recording for recording in recordings if recording is not None]
    moving = informative_coordinates(samples[TRAIN].positions)
    if len(known) < len(recordings) or not moving.any():
        return None
    commands, positions = stacked_commands(samples), stacked_positions(samples, moving)
    fit = fit_smoothly(commands, positions, np.arange(len(commands)))
    if fit.degree == 0 or len(commands) < FEWEST_ROWS:
        return None
    residuals = fit.residuals(commands, positions)
    order, session = (np.concatenate([getattr(each, name) for each in known]) for name in ("order", "session"))
    good = np.asarray(np.abs(residuals) <= np.maximum(GROSS * fit.scale, 0.01 * fit.extent)).all(axis=1)
    rows = np.argsort(order, kind="stable")
    rows = rows[np.asarray(good)[rows]]
    inputs = np.concatenate([part.inputs for part in samples.values()])[rows]
    _, previous, plays, _ = input_parts(inputs, commands.shape[1])
    names = np.array(coordinate_columns(len(moving) // 3))[moving]
    stops = (commands[rows][:, None] - plays).reshape(len(rows), len(WIDTHS) * commands.shape[1])
    return TimeResiduals(
        residuals[rows],
        tuple(names.tolist()),
        order[rows],
        session[rows],
        commands[rows],
        commands[rows] - previous,
        stops,
        fit.degree,
    )


def lag_one(residuals: Array, pairs: NDArray[np.intp]) -> Array:
    """Correlation (n_coordinates,) of residuals (n_rows, n_coordinates) with the next ones, over `pairs`."""
    here, there = residuals[pairs], residuals[pairs + 1]
    here, there = here - here.mean(axis=0), there - there.mean(axis=0)
    size = np.sqrt((here**2).sum(axis=0) * (there**2).sum(axis=0))
    return np.asarray((here * there).sum(axis=0) / np.where(size > 0, size, 1.0))
