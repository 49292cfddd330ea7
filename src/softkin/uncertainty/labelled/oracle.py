"""The oracle: intervals calibrated on the very rows that they are scored on, each row left out of its own.

Two of them. The measure of all other methods is the best of a family of intervals that grow with the distance beyond
`train`, as those of outer shells do. The other has nearly constant width: where errors grow it flatters what is
compared with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from softkin.core.rows import Indices, row_groups
from softkin.core.samples import Array
from softkin.uncertainty.conformal import conformal_limits, conformal_rank
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE
from softkin.uncertainty.labelled.spec import ALL_LABELS, Answer, Labelled, LabelledMethod

#: How fast log width may grow with log distance, at the edge of `train` and at the farthest command.
SLOPES = (0.0, 1.0, 2.5, 6.0, 14.0, 32.0)
N_FOLDS = 5


def answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int) -> Answer:
    """The best intervals that grow with the distance beyond `train`, made with all labels.

    Half-widths are a limit times a difficulty, whose logarithm is quadratic in that of the distance and never falls;
    constant width is among them. Rows are divided into folds, the rows of a command into one. For each fold and
    coordinate the other folds' rows tell the difficulty, by the lowest mean Winkler score over levels, and the
    conformal limit. Both are made of the same rows, hence no guarantee. Infinite where there are too few rows.
    """
    errors = np.abs(labelled.errors)
    radius = labelled.norm(labelled.train_commands).max()
    log_distances = np.log(np.maximum(labelled.norm(labelled.commands) / radius, 1.0))
    difficulties = list(_difficulties(log_distances))
    halves = np.empty((len(confidence_levels), *errors.shape))
    for others, fold in _folds(labelled.commands, seed):
        best = np.full(errors.shape[1], np.inf)
        for difficulty in difficulties:
            limits = conformal_limits(errors[others] / difficulty[others, None], confidence_levels)
            score = _winkler(errors[others], limits[:, None] * difficulty[others, None], confidence_levels)
            better = (score < best) | np.isinf(best)
            made = limits[:, None] * difficulty[fold, None]
            halves[:, fold] = np.where(better, made, halves[:, fold])
            best = np.where(better, score, best)
    return Answer(halves, np.arange(len(errors)), [""] * len(confidence_levels))


def _folds(commands: Array, seed: int) -> Iterator[tuple[Indices, Indices]]:
    """(rows of the other folds, rows of a fold): at most `N_FOLDS`, all rows of a command in one."""
    groups = row_groups(commands)
    fold_of_row = np.random.default_rng(seed).permutation(groups.max() + 1)[groups] % N_FOLDS
    for fold in np.unique(fold_of_row):
        yield np.flatnonzero(fold_of_row != fold), np.flatnonzero(fold_of_row == fold)


def _difficulties(log_distances: Array) -> Iterator[Array]:
    """Difficulties (n_rows,), those of constant width first, and alone where no command lies beyond `train`."""
    yield np.ones(len(log_distances))
    farthest = log_distances.max()
    if farthest > 0:
        for near in SLOPES:
            for far in SLOPES:
                if near or far:
                    yield np.exp(near * log_distances + (far - near) * log_distances**2 / (2 * farthest))


def _winkler(errors: Array, halves: Array, confidence_levels: Sequence[float]) -> Array:
    """Mean Winkler score (n_coordinates,) over rows and those levels whose half-widths (n_levels, n_rows,
    n_coordinates) are finite; 0 where none is.
    """
    missed = 2.0 / (1.0 - np.array(confidence_levels))[:, None, None] * np.maximum(errors - halves, 0.0)
    finite = np.isfinite(halves[:, :1])
    total = np.where(finite, 2 * halves + missed, 0.0).mean(axis=1).sum(axis=0)
    return np.asarray(total / np.maximum(finite.sum(axis=(0, 1)), 1))


def constant_answer(labelled: Labelled, confidence_levels: Sequence[float], seed: int) -> Answer:
    """Split conformal prediction calibrated on all other rows: the interval of nearly constant width that all labels
    allow. Infinite where there are too few rows.
    """
    scores = np.abs(labelled.errors)
    halves = np.stack([_others_limits(scores, level) for level in confidence_levels])
    return Answer(halves, np.arange(len(scores)), [""] * len(confidence_levels))


def _others_limits(scores: Array, level: float) -> Array:
    """Conformal limit (n_rows, n_columns) of the scores (n_rows, n_columns) of all other rows."""
    rank = conformal_rank(len(scores) - 1, level)
    if rank is None:
        return np.full(scores.shape, np.inf)
    ordered = np.sort(scores, axis=0)
    return np.asarray(np.where(scores <= ordered[rank - 1], ordered[rank], ordered[rank - 1]))


METHOD = LabelledMethod("oracle", "Oracle", ALL_LABELS, NO_GUARANTEE, answer)
CONSTANT = LabelledMethod("oracle_constant", "Oracle of constant width", ALL_LABELS, MARGINAL, constant_answer)
