"""All numbers of a calibrated model that an exported file needs, at the confidence levels that it stores."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from softkin.core.errors import ConfigError
from softkin.core.samples import command_columns
from softkin.models.plain.describe import numbers_in
from softkin.models.plain.kernels import Node
from softkin.uncertainty import calls
from softkin.uncertainty.export.rounding import known_to
from softkin.uncertainty.plain.describe_robot import estimator_numbers
from softkin.uncertainty.prepared import Prepared

#: Levels that are stored where none are asked for.
LEVELS = (0.8, 0.9, 0.95)


def exported_numbers(robot: Any, confidence_levels: Sequence[float] = LEVELS, *, most: int) -> Node:
    """The numbers of a calibrated model, its `levels` in ascending order, and `tables` of each.

    Parameters:
        robot: the calibrated model.
        confidence_levels: that intervals are stored at.
        most: numbers at most.

    Raises:
        ConfigError: a level is none; a part of the model cannot be written as plain numbers; it has more numbers.
    """
    levels, _ = calls.levels_of(list(confidence_levels), robot.dataset)
    levels = sorted(set(levels))
    prepared = Prepared(robot)
    numbers: Node = dict(prepared.numbers)
    if not prepared.is_scaled:
        raise ConfigError(
            f"intervals of '{robot.method.name}' cannot be written as plain numbers",
            where=robot.dataset,
            fix="deploy another of interval_methods",
        )
    if not numbers["members"]:
        estimator_numbers(robot.estimator, robot.train, has_spread=False)  # says why
    if "centre" not in numbers["surroundings"]:
        raise ConfigError(
            "its command norm cannot be written as plain numbers", where=robot.dataset, fix="use one of softkin's"
        )
    numbers |= {
        "dataset": robot.dataset,
        "commands": list(robot.names.own_commands) or command_columns(robot.names.n_commands),
        "coordinates": robot.names.coordinates,
        "unit": robot.names.unit,
        "model": f"{robot.spec.title} ({robot.preset}), {robot.method.title}",
        "known_to": known_to(robot),
        "levels": levels,
        "tables": [prepared.table((level,)) for level in levels],
        "failures": None if robot.failures is None else robot.failures.numbers(levels),
    }
    if (count := numbers_in(numbers)) > most:
        raise ConfigError(
            f"it has {count} numbers, more than the {most} that such a file may hold",
            where=robot.dataset,
            fix="export it as a Python file, or deploy a smaller model",
        )
    return numbers
