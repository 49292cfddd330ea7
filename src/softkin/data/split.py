"""Split the rows of a robot's own table into the four subsets, by a method that its entry names.

The methods `random`, `group` and `time` first form groups of rows that must stay together. The outer groups, by
standardised command norm, become `extrapolation`; the others are drawn at random: 80 % of their rows for `train`, 10 %
for `validation`, 10 % for `test`; of groups and stretches more for `validation`, since intervals count these. The
method `column` takes the subsets from a column of the file. The methods `session` and `later` split a recording by
time, see `split_in_time`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.recording import Recording
from softkin.core.samples import EXTRAPOLATION, MIN_ROWS, SUBSETS, TEST, TRAIN, VALIDATION, Array
from softkin.data.missing_values import check_whole
from softkin.data.split_in_time import IN_TIME, split_in_time
from softkin.data.times import times

Codes = NDArray[np.int64]

INNER_SHARES = {TRAIN: 0.8, VALIDATION: 0.1, TEST: 0.1}
EXTRAPOLATION_SHARE = 0.3
#: Stretches of time, where the entry names no number. Of stretches or groups so many are `validation`, but at most such
#: a share of those in-domain: intervals count blocks, and 95 % needs 19 (`make benchmark-promises`).
BLOCKS, CALIBRATION_BLOCKS, MOST_CALIBRATED = 100, 19, 0.3
#: How a subset may be spelt in a file that names it, where the entry says nothing else.
SPELLINGS = {subset: subset for subset in SUBSETS} | {"val": VALIDATION, "ext": EXTRAPOLATION}


def has_standardised_norm(entry: Mapping[str, Any]) -> bool:
    """Whether the command norm of a dataset is that of the commands standardised by `train`, by its `entry` in
    config/datasets.yaml: it is where softkin splits the table. Published data, and stand-ins for them, are split by the
    norm of the raw commands.
    """
    return "split" in entry


def split(
    options: Mapping[str, Any],
    commands: Array,
    column: NDArray[Any] | None,
    place: Callable[[int], str],
    recording: Recording | None = None,
) -> Codes:
    """The subset of each row, as its index in `SUBSETS` (n_rows,).

    Parameters:
        options: the key `split` of the entry: `method`, and the options of that method.
        commands: (n_rows, n_commands).
        column: values (n_rows,) of the file's column that `options` names, text or numbers; None where it names none.
        place: row number -> where the row stands in the file, for messages.
        recording: when the rows were recorded, where the entry says it.

    Raises:
        DataError: a subset would be empty, or a value of `column` cannot be used; names the row and the column.
    """
    if options["method"] == "column":
        return _named_subsets(options, column, place)
    if options["method"] in IN_TIME:
        outer = options.get("extrapolation_share", EXTRAPOLATION_SHARE)
        return split_in_time(options, standardised_norms(commands), recording, outer)
    groups = GROUPS[options["method"]](options, commands, column, place)
    return _drawn_subsets(options, groups, standardised_norms(commands))


def standardised_norms(commands: Array) -> Array:
    """Norm (n_rows,) of commands (n_rows, n_commands) that are standardised to mean 0 and variance 1; constant
    commands are left out.
    """
    largest = np.abs(commands).max(axis=0)
    scaled = commands / np.where(largest > 0, largest, 1.0)  # squares of very small numbers would vanish
    spread = scaled.std(axis=0)
    varies = (np.ptp(scaled, axis=0) > 0) & (spread > 0)
    standardised = (scaled[:, varies] - scaled[:, varies].mean(axis=0)) / spread[varies]
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", standardised, standardised)))


def check_sizes(sizes: Mapping[str, int]) -> None:
    """Check the number of rows of each subset.

    Raises:
        DataError: so few that the workflow could not go to its end; names each such subset.
    """
    few = [
        f"{subset} gets {sizes[subset]} of at least {least}"
        for subset, least in MIN_ROWS.items()
        if sizes[subset] < least
    ]
    if few:
        raise DataError(
            f"{sum(sizes.values())} rows are too few: {', '.join(few)}",
            fix="record more, best some hundred or more",
        )


def wanted_shares(options: Mapping[str, Any]) -> dict[str, float]:
    """Share of all rows that each subset should get; empty where the file or its sessions decide."""
    if options["method"] in ("column", "session"):
        return {}
    outer = options.get("extrapolation_share", EXTRAPOLATION_SHARE)
    inner = INNER_SHARES if options["method"] in ("random", "later") else {TEST: INNER_SHARES[TEST]}
    return {subset: (1 - outer) * share for subset, share in inner.items()} | {EXTRAPOLATION: outer}


def _named_subsets(options: Mapping[str, Any], column: NDArray[Any] | None, place: Callable[[int], str]) -> Codes:
    assert column is not None
    spellings = {str(name): subset for subset, name in options["names"].items()} if "names" in options else SPELLINGS
    codes, values = _factorize(column)
    texts = [str(value).strip() for value in values]
    for code, text in enumerate(texts):
        if text not in spellings:
            raise DataError(
                f"'{text}' is the name of no subset",
                where=f"{place(int(np.argmax(codes == code)))}, column '{options['column']}'",
                fix=f"write one of {', '.join(spellings)}, or say in `names` of `split` what the file calls each",
            )
    missing = [subset for subset in SUBSETS if subset not in {spellings[text] for text in texts}]
    if missing:
        raise DataError(
            f"no row of {' or '.join(missing)}",
            where=f"column '{options['column']}'",
            fix="name rows of all four subsets there, or let softkin draw them with split: {method: random}",
        )
    return np.array([SUBSETS.index(spellings[text]) for text in texts])[codes]


def _drawn_subsets(options: Mapping[str, Any], groups: Codes, norms: Array) -> Codes:
    n_groups = int(groups.max()) + 1
    if n_groups < len(SUBSETS):
        raise DataError(
            f"{_counted(n_groups, options)}, but four subsets need at least four",
            where=f"column '{options['column']}'" if "column" in options else "commands",
            fix="record more, or choose another `method` of `split`",
        )
    sizes = np.bincount(groups)
    largest_norms = np.zeros(n_groups)
    np.maximum.at(largest_norms, groups, norms)
    order = np.argsort(largest_norms, kind="stable")
    # Groups of one norm are not separated; equal up to rounding, since the mean is subtracted.
    cuts = 1 + np.flatnonzero(np.diff(largest_norms[order]) > 1e-9 * largest_norms.max())
    cuts = cuts[cuts >= len(INNER_SHARES)]
    if not cuts.size:
        raise DataError(
            f"extrapolation would be empty: of {_counted(n_groups, options)}, none lie farther out than three or more "
            "others by the norm of their standardised commands",
            where="commands",
            fix="record more distinct commands, or name the subsets in a column of the file with "
            "split: {method: column, column: ...}",
        )
    inner_rows = np.cumsum(sizes[order])[cuts - 1]
    outer = options.get("extrapolation_share", EXTRAPOLATION_SHARE)
    cut = int(cuts[np.argmin(np.abs(inner_rows - (1 - outer) * len(groups)))])

    subset_of = np.full(n_groups, SUBSETS.index(EXTRAPOLATION))
    drawn = np.random.default_rng(options.get("seed", 0)).permutation(order[:cut])
    filled = np.cumsum(sizes[drawn])
    first = _nearest(filled, INNER_SHARES[TRAIN], low=1, high=cut - 2)
    second = _nearest(filled, INNER_SHARES[TRAIN] + INNER_SHARES[VALIDATION], low=first + 1, high=cut - 1)
    if options["method"] != "random":
        first = max(1, min(first, second - min(CALIBRATION_BLOCKS, int(MOST_CALIBRATED * cut))))
    for subset, part in ((TRAIN, drawn[:first]), (VALIDATION, drawn[first:second]), (TEST, drawn[second:])):
        subset_of[part] = SUBSETS.index(subset)
    return np.asarray(subset_of[groups])


def _nearest(filled: Codes, share: float, *, low: int, high: int) -> int:
    """How many groups, from `low` to `high`, fill the nearest to `share` of all rows."""
    return low + int(np.argmin(np.abs(filled[low - 1 : high] - share * filled[-1])))


def _same_command(
    _options: Mapping[str, Any], commands: Array, _column: NDArray[Any] | None, _place: Callable[[int], str]
) -> Codes:
    import pandas as pd

    frame = pd.DataFrame(commands)
    return np.asarray(frame.groupby(list(frame.columns), sort=False).ngroup().to_numpy(np.int64))


def _same_value(
    options: Mapping[str, Any], _commands: Array, column: NDArray[Any] | None, place: Callable[[int], str]
) -> Codes:
    assert column is not None
    check_whole(options["column"], column, "group", place)
    return _factorize(column)[0]


def _same_stretch(
    options: Mapping[str, Any], commands: Array, column: NDArray[Any] | None, place: Callable[[int], str]
) -> Codes:
    """Stretches of equal size of the recording in the order of time, that of the file where no column tells it; rows of
    one time stay together.
    """
    when: NDArray[Any] = np.arange(len(commands))
    if column is not None:
        check_whole(options["column"], column, "time", place)
        when = times(options["column"], column, place)
    rank = np.searchsorted(np.sort(when), when, side="left")
    stretches = rank * options.get("blocks", BLOCKS) // len(when)
    return np.asarray(np.unique(stretches, return_inverse=True)[1])


def _factorize(column: NDArray[Any]) -> tuple[Codes, list[Any]]:
    import pandas as pd

    codes, values = pd.factorize(column, use_na_sentinel=False)
    return np.asarray(codes, dtype=np.int64), list(values)


#: Method -> groups(options, commands, column, place): a number per row (n_rows,), the same for rows that stay together.
GROUPS: dict[str, Callable[..., Codes]] = {"random": _same_command, "group": _same_value, "time": _same_stretch}
#: What its groups are, one and many.
_KINDS = {
    "random": ("distinct command", "distinct commands"),
    "group": ("group", "groups"),
    "time": ("stretch of time", "stretches of time"),
}


def _counted(n_groups: int, options: Mapping[str, Any]) -> str:
    return f"{n_groups} {_KINDS[options['method']][n_groups != 1]}"
