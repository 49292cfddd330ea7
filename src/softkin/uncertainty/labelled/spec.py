"""What a method out there sees and gives."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array

#: What a method has looked at of the rows that it is scored on.
NO_LABELS, ALL_LABELS, ONE_BY_ONE = "none", "all", "all, each after its interval"
#: Promised of the average over many rows, in whatever order they come.
LONG_RUN = "long-run average"


@dataclass(frozen=True, slots=True)
class Labelled:
    """One model's errors (n_rows, n_coordinates) in mm on the calibration rows and on those that get intervals, and
    their commands (n_rows, n_commands). `norm` takes commands to how far out they lie (n_rows,).
    """

    train_commands: Array
    calibration_commands: Array
    calibration_errors: Array
    commands: Array
    errors: Array
    norm: Callable[[Array], Array]


@dataclass(frozen=True, slots=True)
class Answer:
    """Half-widths (n_levels, n_scored, n_coordinates) in mm of the rows `scored`; `refused` holds for each level why
    there are none, or nothing. `details` are numbers to be read first.
    """

    half_widths: Array
    scored: NDArray[np.intp]
    refused: Sequence[str]
    details: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class LabelledMethod:
    """One way to put symmetric intervals around predictions for commands outside `train`.

    `answer(labelled, confidence_levels, seed)`; `labels` says what it has looked at, `guarantee` what it promises.
    """

    name: str
    title: str
    labels: str
    guarantee: str
    answer: Callable[[Labelled, Sequence[float], int], Answer]
