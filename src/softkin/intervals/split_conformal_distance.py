"""Normalised split conformal prediction: wider where the command lies far from those that were trained on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.conformal import conformal_rank, normalised_intervals
from softkin.interface import MARGINAL, Array, Evidence, IntervalMethod

NEIGHBOURS = 10
#: Difficulty of a command that stands in `train` many times over, where 1 is that of a typical one.
LEAST_DIFFICULTY = 0.1


def intervals(evidence: Evidence, confidence_levels: Sequence[float]) -> Array:
    """Half-width proportional to a difficulty that knows no truth: the mean distance to the nearest train commands.

    In standardised command space, in units of the same distance within `train`. Not crepes' own estimate from
    neighbours, which stops growing at the edge of the training box (0.9.1, `clip`).
    Source: Papadopoulos, Vovk and Gammerman (2011); crepes.ConformalRegressor with `sigmas`.
    """
    assert evidence.train_commands is not None
    assert evidence.calibration_commands is not None
    assert evidence.new_commands is not None
    calibration, new = distances(evidence.train_commands, [evidence.calibration_commands, evidence.new_commands])
    shape = (1, evidence.truth.shape[1])
    return normalised_intervals(
        evidence, confidence_levels, np.tile(calibration[:, None], shape), np.tile(new[:, None], shape)
    )


def distances(train: Array, others: Sequence[Array]) -> list[Array]:
    """Difficulty (n_rows,) of each set of commands."""
    from sklearn.neighbors import NearestNeighbors
    from sklearn.preprocessing import StandardScaler

    scaler = StandardScaler().fit(train)
    finder = NearestNeighbors(n_neighbors=min(NEIGHBOURS, len(train) - 1)).fit(scaler.transform(train))
    within = float(finder.kneighbors()[0].mean())
    unit = within if within > 0 else 1.0  # every command many times over
    return [
        LEAST_DIFFICULTY + np.asarray(finder.kneighbors(scaler.transform(rows))[0].mean(axis=1)) / unit
        for rows in others
    ]


METHOD = IntervalMethod(
    "scp_distance",
    "SCP, by distance",
    on="predictions",
    guarantee=MARGINAL,
    intervals=intervals,
    rank=conformal_rank,
)
