"""Splits of a recording by time, which are honest about a robot that remembers or drifts.

The outer rows by standardised command norm become `extrapolation`. Of the others, `session` tests on the last session,
fits on those before, and draws the calibration set from stretches of these; `later` fits on the first 80 % in time,
calibrates on the next 10 % and tests on the last.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from softkin.core.errors import DataError
from softkin.core.recording import Recording, Whole
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, VALIDATION, Array

#: Of the rows that are fitted and calibrated on, the share that is calibrated on.
CALIBRATED_SHARE = 1 / 9
STRETCHES = 50


def split_in_time(options: Mapping[str, Any], norms: Array, recording: Recording | None, outer: float) -> Whole:
    """The subset of each row, as its index in `SUBSETS` (n_rows,).

    Parameters:
        options: the key `split` of the entry.
        norms: standardised command norms (n_rows,).
        recording: of all rows.
        outer: share of rows that is extrapolation.

    Raises:
        DataError: there is no recording, or it has one session where the split is by session.
    """
    if recording is None:
        raise DataError(
            f"a split by `method: {options['method']}` needs the order in time",
            where="`split`",
            fix="name the columns of `order` and `session` in the entry",
        )
    subset_of = np.full(len(norms), SUBSETS.index(EXTRAPOLATION))
    inner = np.flatnonzero(norms <= np.quantile(norms, 1 - outer))
    inner = inner[np.argsort(recording.order[inner], kind="stable")]
    parts = IN_TIME[options["method"]](recording.session[inner], options.get("seed", 0))
    subset_of[inner] = parts
    for subset in SUBSETS:
        if not (subset_of == SUBSETS.index(subset)).any():
            raise DataError(
                f"{subset} would be empty",
                where=f"`split`, {len(norms)} rows",
                fix="record more, or choose another `method` of `split`",
            )
    return subset_of


def _session(session: Whole, seed: int) -> Whole:
    """Rows (n_rows,) in the order of time: the last session is `test`, stretches of the others are `validation`."""
    if session[0] == session[-1]:
        raise DataError(
            "one session, so there is no next one",
            where="`split`",
            fix="name the column of `session` in the entry, or write method: later",
        )
    before = int(np.searchsorted(session, session[-1]))
    stretches = np.arange(before) * min(STRETCHES, before) // before
    drawn = np.random.default_rng(seed).permutation(int(stretches[-1]) + 1)
    calibrated = drawn[: max(1, round(CALIBRATED_SHARE * len(drawn)))]
    parts = np.full(len(session), SUBSETS.index(TEST))
    parts[:before] = np.where(np.isin(stretches, calibrated), SUBSETS.index(VALIDATION), SUBSETS.index(TRAIN))
    return parts


def _later(session: Whole, _seed: int) -> Whole:
    """Rows (n_rows,) in the order of time: 80 % `train`, then 10 % `validation`, then `test`."""
    share = np.arange(len(session)) / len(session)
    return np.select([share < 0.8, share < 0.9], [SUBSETS.index(TRAIN), SUBSETS.index(VALIDATION)], SUBSETS.index(TEST))


#: Method -> parts(session, seed): of inner rows in the order of time, with their session (n_rows,), the subset of each.
IN_TIME: dict[str, Callable[[Whole, int], Whole]] = {"session": _session, "later": _later}
