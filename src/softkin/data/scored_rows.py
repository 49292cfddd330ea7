"""Rows that models are calibrated and scored on: all that a recording has, or of very many some.

Every model predicts these rows, and every interval method bounds them; thousands more tell no more of coverage.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import Indices
from softkin.core.samples import TRAIN, Samples

logger = logging.getLogger("softkin")

#: Key of a dataset's description and card: subset -> its rows before some of them were drawn.
DRAWN_FROM = "drawn_from"
#: What the rows are drawn with: the same whatever the seed of a run, so that runs of two seeds are scored on the same.
SEED = 0


@dataclass(frozen=True, slots=True)
class KeptRows:
    """How many rows of each subset are kept at most, None for all: of any the `first` ones, to try the workflow out; of
    each but `train` so many to be `scored`, drawn at random.
    """

    first: int | None = None
    scored: int | None = None


ALL_ROWS = KeptRows()


def scored_rows(samples: Mapping[str, Samples], kept: KeptRows) -> tuple[dict[str, Samples], dict[str, int]]:
    """The samples of all subsets with the rows that are scored, in their order; and how many rows those subsets had of
    which some were drawn.
    """
    left, drawn_from = dict(samples), {}
    for subset, rows in samples.items():
        if subset != TRAIN and kept.scored is not None and len(rows) > kept.scored:
            left[subset] = rows.take(drawn_rows(len(rows), rows.block, kept.scored, SEED))
            drawn_from[subset] = len(rows)
            logger.warning("%d of %d rows of %s are kept: max_scored_rows", kept.scored, len(rows), subset)
    return left, drawn_from


def drawn_rows(n_rows: int, block: NDArray[np.int64] | None, n_drawn: int, seed: int) -> Indices:
    """Ascending numbers of `n_drawn` rows, drawn without replacement: a row of each block first, in any order of
    blocks, since intervals count blocks; then rows of any block.
    """
    rng = np.random.default_rng(seed)
    order = rng.permutation(n_rows)
    if block is not None:
        first = rng.permutation(np.unique(block[order], return_index=True)[1])
        order = np.concatenate([order[first], np.delete(order, first)])
    return np.sort(order[:n_drawn])
