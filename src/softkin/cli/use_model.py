"""Use a calibrated model on tables: predictions at commands, targets, and whether a robot is where the model says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from softkin.core.errors import DataError
from softkin.core.rotations import XYZW
from softkin.core.samples import command_columns, informative_coordinates
from softkin.core.units import MM, own_unit
from softkin.data.readers.table_formats import open_table
from softkin.uncertainty.calibrated_model import CalibratedModel
from softkin.uncertainty.calls import Names
from softkin.uncertainty.control_loop import State
from softkin.uncertainty.intervals.spec import NO_GUARANTEE
from softkin.uncertainty.orientations import COLUMNS
from softkin.uncertainty.promise import worth_of_p_values
from softkin.uncertainty.targets import TargetNames, marker_of

#: Share of false alarms that p-values are counted at.
ALPHA = 0.1


@dataclass(frozen=True, slots=True)
class Checked:
    """What a recording says of a robot: poses in all and outside, the share of those inside with a p-value of at most
    `ALPHA`, and the pose (from 1, in the file) and coordinates of the alarm, if it went off; what both are worth where
    rows are not exchangeable.
    """

    n_poses: int
    n_outside: int
    share_of_small_p_values: float | None
    median_error_mm: float
    alarm_pose: int | None
    alarm_coordinates: tuple[str, ...]
    rate: float
    unit: str = MM
    worth_of_p_values: str = ""
    worth_of_alarm: str = ""

    def sentences(self) -> list[str]:
        """The same in words."""
        lines = [f"{self.n_poses} poses, {self.n_outside} of them outside, where nothing is promised."]
        lines += [f"Half of the markers are within {self.median_error_mm:.3g} {self.unit} of where the model says."]
        if self.share_of_small_p_values is None:
            return [*lines, "No pose is inside: nothing can be said of the robot."]
        promised = "at most" if self.worth_of_p_values else "about"
        expected = f"; of a robot that is where the model says, {promised} {ALPHA:.0%} have"
        small = f"Inside, {self.share_of_small_p_values:.0%} of the poses have a p-value of at most {ALPHA:.0%}"
        lines += [f"{small}{'' if NO_GUARANTEE in self.worth_of_p_values else expected}."]
        lines += [said for said in (self.worth_of_p_values, self.worth_of_alarm) if said]
        if self.alarm_pose is None:
            return [*lines, f"No alarm, at a rate of {self.rate:g} false alarms: the robot is where the model says."]
        where = ", ".join(self.alarm_coordinates) or "no coordinate by itself"
        found = "the robot is no longer where the model says"
        if self.worth_of_alarm:
            found = f"{found}, or only this stretch of time is unlike those that the model was calibrated on"
        return [
            *lines,
            f"ALARM at pose {self.alarm_pose} ({where}), at a rate of {self.rate:g} false alarms: {found}. Recalibrate "
            "it on a few labelled poses, or identify it again.",
        ]


def predicted_table(
    robot: CalibratedModel, commands: pd.DataFrame, level: float, *, joint: bool = False
) -> pd.DataFrame:
    """Positions, bounds at the level and `outside`, a row for each command; with `joint` the bounds that hold the whole
    pose; of a robot that fails the probability of it, and whether it is so high that bounds hold failed poses, too.
    Commands of a robot that remembers are taken as sent one after the other from rest. Where the tip's orientation is
    modelled, it is a quaternion, `tip_qx` to `tip_qw`, with the bound of its angle. Of a robot that is not in mm the
    last column is its `unit`.
    """
    inputs = State(robot).inputs(commands.to_numpy(dtype=np.float64))
    positions = np.asarray(robot.predict(inputs))
    asked = robot.joint_intervals(inputs, level).bounds if joint else robot.intervals(inputs, level, positions)
    bounds = np.asarray(asked)
    names, prefix = robot.names.coordinates, "joint_" if joint else ""
    parts = {"": positions, f"{prefix}lower_": bounds[..., 0], f"{prefix}upper_": bounds[..., 1]}
    frame = pd.DataFrame({f"{side}{name}": part[:, i] for i, name in enumerate(names) for side, part in parts.items()})
    frame = frame.assign(outside=np.asarray(robot.is_outside(inputs)))
    if robot.failures is not None:
        may_fail = robot.failures.may_fail(commands.to_numpy(dtype=np.float64), [level])[0]
        frame = frame.assign(failure_probability=robot.failure_probability(inputs), may_fail=may_fail)
    turned = robot.orientation(inputs, level)
    if turned is not None:
        columns = dict(zip(COLUMNS[XYZW], np.asarray(turned.rotations).T, strict=True))
        frame = frame.assign(**{f"tip_{name}": column for name, column in columns.items()}, bound_deg=turned.bound_deg)
    return frame.assign(**own_unit(robot.names.unit))


def check_recording(robot: CalibratedModel, commands: pd.DataFrame, positions: pd.DataFrame, rate: float) -> Checked:
    """What a recording, in the order in which it was made, says of the robot; positions in its unit."""
    inputs, measured = State(robot).inputs(commands.to_numpy(dtype=np.float64)), positions.to_numpy()
    inside = ~np.asarray(robot.is_outside(inputs))
    joint = np.asarray(robot.p_values(inputs, measured)[1])[inside]
    errors = measured - np.asarray(robot.predict(inputs))
    moving = informative_coordinates(robot.train.positions)
    watch, alarm, at = robot.watch(rate), None, None
    for place in np.flatnonzero(inside):
        alarm = watch.judge(errors[place, moving])
        if alarm is not None:
            at = int(place) + 1
            break
    return Checked(
        n_poses=len(inputs),
        n_outside=int((~inside).sum()),
        share_of_small_p_values=float((joint <= ALPHA).mean()) if len(joint) else None,
        median_error_mm=float(np.median(np.linalg.norm(errors.reshape(len(errors), -1, 3), axis=2))),
        alarm_pose=at,
        alarm_coordinates=() if alarm is None else alarm.coordinates,
        rate=rate,
        unit=robot.names.unit,
        worth_of_p_values=worth_of_p_values(robot.joint.promise),
        worth_of_alarm=watch.worth,
    )


def read_rows(path: Path, names: Names, *, measured: bool) -> tuple[pd.DataFrame, pd.DataFrame | None, list[str]]:
    """Commands of a CSV or Parquet file, positions where they were `measured`, and the columns not read.

    Raises:
        DataError: no such file, no table, or columns are missing.
    """
    kinds = [[names.own_commands, command_columns(names.n_commands)]]
    kinds += [[names.own_positions, names.coordinates]] if measured else []
    frame, unread = _read(path, kinds)
    command_names = _nearest(kinds[0], [*frame.columns, *unread])
    commands = names.commands_in(frame[[name for name in frame.columns if name in command_names]], str(path))
    positions = None
    if measured:
        positions = names.positions_in(frame[[name for name in frame.columns if name not in command_names]], str(path))
    _check_rows(frame, path)
    return commands, positions, unread


def read_targets(path: Path, names: Names, marker: int) -> tuple[pd.DataFrame, list[str]]:
    """Targets of a marker of a CSV or Parquet file, columns m1_x, m1_y, m1_z, and the columns not read.

    Raises:
        DataError, ConfigError: no such file, no table, columns are missing, or no such marker.
    """
    own = TargetNames.of_marker(names, marker_of(marker, names.n_coordinates // 3, str(path)))
    frame, unread = _read(path, [[own.own_positions, own.coordinates]])
    targets = own.positions_in(frame, str(path))
    _check_rows(frame, path)
    return targets, unread


def command_table(
    robot: CalibratedModel, targets: pd.DataFrame, marker: int, level: float, tolerance: float | None, *, path: bool
) -> pd.DataFrame:
    """Commands that take the marker nearest to targets, by the robot's own names, and what is promised there; along a
    `path` sent one after the other from rest.
    """
    asked = robot.command_path if path else robot.command_for
    answers = pd.DataFrame(asked(targets, marker, level, tolerance=tolerance))
    return answers.assign(**own_unit(robot.names.unit))


def finite(value: Any) -> Any:
    """A number for JSON, which has no infinity: None in its place."""
    return value if not isinstance(value, float) or np.isfinite(value) else None


def _read(path: Path, kinds: Sequence[Sequence[Sequence[str]]]) -> tuple[pd.DataFrame, list[str]]:
    """The columns that are there, each kind by the naming that fits best, and the names of the others."""
    if not path.is_file():
        raise DataError("no such file", where=path, fix="name a CSV or Parquet file with a row for each command")
    try:
        table = open_table(path, {})
        wanted = [column for namings in kinds for column in _nearest(namings, table.names)]
        there = [name for name in wanted if name in table.names]
        values, _ = table.read([table.names.index(name) for name in there], [])
    except DataError as error:
        raise error.within(str(path)) from error
    return pd.DataFrame(values, columns=there), [name for name in table.names if name not in there]


def _check_rows(frame: pd.DataFrame, path: Path) -> None:
    if not len(frame):
        raise DataError("no rows", where=path, fix="name a file with a row for each command")


def _nearest(namings: Sequence[Sequence[str]], given: Sequence[str]) -> list[str]:
    return list(max((naming for naming in namings if len(naming)), key=lambda naming: len(set(naming) & set(given))))
