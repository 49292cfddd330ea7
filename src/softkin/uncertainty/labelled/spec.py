"""Specification of a labelled method: an entry of the registry, its input and its answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array

#: True positions that a method uses of the rows it is scored on.
NO_LABELS, ALL_LABELS, ONE_BY_ONE = "none", "all", "all, each after its interval"
#: Guarantee of the average coverage over many rows, in any order.
LONG_RUN = "long-run average"


@dataclass(frozen=True, slots=True)
class Labelled:
    """Errors (n_rows, n_coordinates) in mm of one run on the calibration rows and on those that get intervals, and
    their commands (n_rows, n_commands). `norm` maps commands to their command norms (n_rows,).
    """

    train_commands: Array
    calibration_commands: Array
    calibration_errors: Array
    commands: Array
    errors: Array
    norm: Callable[[Array], Array]


@dataclass(frozen=True, slots=True)
class Answer:
    """Half-widths (n_levels, n_scored, n_coordinates) in mm of the rows `scored`. `refused` is, level by level, the
    reason why there are none, or empty. `details` are diagnostics to be read before the scores.
    """

    half_widths: Array
    scored: NDArray[np.intp]
    refused: Sequence[str]
    details: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class LabelledMethod:
    """One way to put symmetric intervals around predictions with the help of labels.

    `answer(labelled, confidence_levels, seed)` returns the half-widths. `labels` says which true positions it uses of
    the rows it is scored on, `guarantee` what coverage is guaranteed.
    """

    name: str
    title: str
    labels: str
    guarantee: str
    answer: Callable[[Labelled, Sequence[float], int], Answer]
