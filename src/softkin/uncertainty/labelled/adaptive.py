"""Adaptive conformal inference, row by row: intervals widen after each miss and narrow a little after each hit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.labelled.spec import LONG_RUN, ONE_BY_ONE, Answer, Labelled, LabelledMethod

#: Step size: how much one row moves the level.
STEP = 0.05


def answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int) -> Answer:
    """Gibbs and Candes (2021), equation 2, over the rows in ascending order of command norm.

    The position of each row is measured after its interval. Scores are the latest ones, as many as there are
    calibration rows; at the start they are those of the calibration rows.
    """
    order = np.argsort(labelled.norm(labelled.commands), kind="stable")
    start, scores = np.abs(labelled.calibration_errors), np.abs(labelled.errors)[order]
    halves = np.empty((len(confidence_levels), *scores.shape))
    for place, level in enumerate(confidence_levels):
        halves[place, order] = trajectory(start, scores, level)
    return Answer(halves, np.arange(len(scores)), [""] * len(confidence_levels))


def trajectory(start: Array, scores: Array, confidence_level: float, step: float = STEP) -> Array:
    """Half-widths (n_rows, n_columns) of rows in their order, each from the scores (n_rows, n_columns) before its own.

    `start` (n_calibration, n_columns) are the scores before the first row. The level of a column may leave 0 to 1: then
    its interval is infinite, or a point. So the share of misses is within 1 / (step * n_rows) of the nominal one,
    whatever the scores (their proposition 4.1).
    mapie.regression.TimeSeriesRegressor (1.6.0) clips the level to 0 to 1, which breaks that bound, rounds it to two
    digits, and predicts row by row and column by column; where it does not clip, it does the same.
    """
    pool, n = start.copy(), len(start)
    miscoverage = 1 - confidence_level
    alpha = np.full(scores.shape[1], miscoverage)
    halves = np.empty_like(scores)
    columns = np.arange(scores.shape[1])
    for row, score in enumerate(scores):
        ranks = np.ceil((1 - alpha) * (n + 1) - 1e-9).astype(int)
        ordered = np.sort(pool, axis=0)[np.clip(ranks, 1, n) - 1, columns]
        halves[row] = np.where(ranks > n, np.inf, np.where(ranks < 1, 0.0, ordered))
        alpha += step * (miscoverage - (score > halves[row]))
        pool[row % n] = score
    return halves


METHOD = LabelledMethod("adaptive", "Adaptive, row by row", ONE_BY_ONE, LONG_RUN, answer)
