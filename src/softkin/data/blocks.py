"""Blocks of rows that a split keeps together: what is exchangeable of a table, where its rows are not.

Stretches of time and groups are drawn at random as wholes, and so are rows of one command where commands repeat. A
recording that is split by time or by session is drawn by nothing: what is held out is one block, the future.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.data.split import GROUPS, Codes
from softkin.data.split_in_time import IN_TIME


def blocks(
    options: Mapping[str, Any],
    commands: Array,
    column: NDArray[Any] | None,
    place: Callable[[int], str],
) -> Codes | None:
    """The number (n_rows,) of each row's block, parameters as of `split.split`; None where each row is one for itself,
    or the file names the subsets and nothing is known.
    """
    if options["method"] in IN_TIME:
        return np.zeros(len(commands), dtype=np.int64)
    if options["method"] not in GROUPS:
        return None
    numbers = GROUPS[options["method"]](options, commands, column, place)
    return None if int(numbers.max()) + 1 == len(numbers) else numbers
