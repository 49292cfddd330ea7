"""Folds of cross-validation in which copies of a command stay together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.model_selection import GroupKFold

from softkin.core.errors import DataError
from softkin.core.samples import Array

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
