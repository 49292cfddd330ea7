"""Rows that are gross errors by the audit: stuck poses and gross outliers. Scores are given with and without them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import command_scale, split_by_subset, stacked_commands, stacked_positions
from softkin.core.samples import TRAIN, Samples, informative_coordinates
from softkin.data.audit.gross_outliers import far_off
from softkin.data.audit.stuck_poses import stuck


def gross_rows(samples: Mapping[str, Samples], seed: int = 0) -> dict[str, NDArray[np.bool_]]:
    """Subset -> mask (n_rows,) of the rows that the findings `stuck_poses` and `gross_outliers` of a data card name.

    It looks at commands and positions of `samples`, `train` among them, and at no prediction: the same rows for every
    model. What is chosen by it is given `train` and `validation` alone.
    """
    moving = informative_coordinates(samples[TRAIN].positions)
    if not moving.any():
        return {subset: np.zeros(len(rows), dtype=bool) for subset, rows in samples.items()}
    commands, positions = stacked_commands(samples), stacked_positions(samples, moving)
    mask, _, _ = stuck(commands, positions, seed)
    mask |= far_off(commands, positions, command_scale(samples[TRAIN].commands), seed)[0]
    return {subset: part.astype(bool) for subset, part in split_by_subset(mask, samples).items()}
