"""Folds of cross-validation: copies of a command stay together, and in a recording neighbours in time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.model_selection import GroupKFold

from softkin.core.errors import DataError
from softkin.core.samples import Array, Samples

#: Stretches of time in each fold of a recording: few enough that most rows have their neighbours in the same fold, and
#: so many that each fold has rows of each session.
STRETCHES = 10

Folds = list[tuple[NDArray[np.intp], NDArray[np.intp]]]


def grouped_folds(commands: Array, n_folds: int, seed: int) -> Folds:
    """Shuffled folds (fitted rows, held-out rows); all rows of a distinct command stand on the same side.

    Raises:
        DataError: fewer distinct commands than folds.
    """
    _, groups = np.unique(commands, axis=0, return_inverse=True)
    n_groups = int(groups.max()) + 1
    if n_groups < n_folds:
        raise DataError(
            f"{n_groups} distinct commands are too few for {n_folds} folds",
            where="`train`",
            fix="lower tuning.n_folds and refitting.n_folds in the configuration, or record more distinct commands",
        )
    splitter = GroupKFold(n_folds, shuffle=True, random_state=seed)
    return list(splitter.split(commands, groups=groups.ravel()))


def folds_of(samples: Samples, n_folds: int, seed: int) -> Folds:
    """Shuffled folds of samples: by distinct command; of a recording, by stretches of time.

    Rows next to each other in time are alike where a robot remembers or drifts. Held out one by one, each would be
    predicted by its neighbours.

    Raises:
        DataError: fewer distinct commands, or rows of a recording, than folds.
    """
    recording = samples.recording
    if recording is None:
        return grouped_folds(samples.commands, n_folds, seed)
    rank = np.argsort(np.argsort(recording.order, kind="stable"), kind="stable")
    stretches = rank * min(STRETCHES * n_folds, len(samples)) // len(samples)
    return grouped_folds(stretches[:, None].astype(np.float64), n_folds, seed)
