"""How interval methods stand beside the oracle on the same rows: ratios of Winkler scores, and how sure they are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import Indices
from softkin.core.samples import Array

#: Draws of the commands, with replacement, and the share of them within the band of a ratio.
N_DRAWS, BAND = 400, 0.95
SEED = 0


def ratios(
    row_scores: Array, oracle: Sequence[int], commands: Indices, gross: NDArray[np.bool_]
) -> dict[str, NDArray[np.float64]]:
    """Ratios (n_scored,) of mean Winkler scores to those of the oracle, each over the rows that it was given.

    `winkler_ratio_to_oracle` counts all rows, `ratio_without_gross` those that are no gross errors; `ratio_low` and
    `ratio_high` hold the first in 95 % of `N_DRAWS` draws, with replacement, of the distinct commands: rows of a
    command are drawn together, and the intervals stay as they are. Infinite where a score is infinite, NaN where a
    method gave no interval.

    Parameters:
        row_scores: Winkler scores (n_scored, n_rows) in mm, means over coordinates; NaN where a row got no interval.
        oracle: which of the scored (n_scored,) is the oracle beside each.
        commands: number (n_rows,) of the distinct command of each row, from 0.
        gross: mask (n_rows,) of gross errors.
    """
    given = ~np.isnan(row_scores)
    sums = np.array([np.bincount(commands, np.nan_to_num(row, posinf=np.inf)) for row in row_scores])
    counts = np.array([np.bincount(commands, row) for row in given])
    n_commands = sums.shape[1]
    rng = np.random.default_rng(SEED)
    drawn = np.empty((N_DRAWS, len(row_scores)))
    for place in range(N_DRAWS):
        weights = np.bincount(rng.integers(n_commands, size=n_commands), minlength=n_commands)
        held = weights > 0  # an infinite score times nothing is no number
        drawn[place] = _ratio(sums[:, held] @ weights[held], counts[:, held] @ weights[held], oracle)
    with np.errstate(invalid="ignore"):
        low, high = np.quantile(drawn, [(1 - BAND) / 2, (1 + BAND) / 2], axis=0, method="nearest")
    regular = ~gross
    return {
        "winkler_ratio_to_oracle": _ratio(sums.sum(axis=1), counts.sum(axis=1), oracle),
        "ratio_low": low,
        "ratio_high": high,
        "ratio_without_gross": _ratio(
            np.nan_to_num(row_scores[:, regular], posinf=np.inf).sum(axis=1), given[:, regular].sum(axis=1), oracle
        ),
    }


def _ratio(sums: Array, counts: Array, oracle: Sequence[int]) -> Array:
    """Ratios (n_scored,) of means to those of the oracle; NaN of infinite oracles, and of nothing."""
    with np.errstate(invalid="ignore", divide="ignore"):
        means = sums / counts
        return np.asarray(means / means[list(oracle)])
