"""Folds of cross-validation in which copies of a command stay together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.model_selection import GroupKFold

from softkin.core.errors import SoftkinError
from softkin.core.samples import Array

Folds = list[tuple[NDArray[np.intp], NDArray[np.intp]]]


def grouped_folds(commands: Array, n_folds: int, seed: int) -> Folds:
    """Shuffled folds (rows inside, rows held out) in which a distinct command stands on one side only.

    Raises:
        SoftkinError: fewer distinct commands than folds.
    """
    _, groups = np.unique(commands, axis=0, return_inverse=True)
    n_groups = int(groups.max()) + 1
    if n_groups < n_folds:
        raise SoftkinError(
            f"`train` has {n_groups} distinct commands, too few for {n_folds} folds; mend: lower the number of folds "
            "in the configuration (tuning.n_folds, refitting.n_folds)"
        )
    splitter = GroupKFold(n_folds, shuffle=True, random_state=seed)
    return list(splitter.split(commands, groups=groups.ravel()))
