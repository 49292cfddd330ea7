"""Which rows of two files belong together: by the value of a column, by nearest time, or by their number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array
from softkin.data.missing_values import lacks_value
from softkin.data.times import times

Rows = NDArray[np.intp]
NEAREST, HOLD, MEAN = RESAMPLING = ("nearest", "hold", "mean")


@dataclass(frozen=True, slots=True)
class Partners:
    """For each row of one file its partner in another, as that row's number, -1 where there is none (n_rows,); where
    partners are averaged, also the rows of the other file in the order of time, and the first and the last but one of
    them that count, for each row.
    """

    rows: Rows
    in_time: Rows | None = None
    first: Rows | None = None
    last: Rows | None = None

    def numbers(self, values: Array) -> Array:
        """Numbers (n_other_rows, n_columns) of the partners (n_rows, n_columns), NaN where there is none; a gap among
        those that are averaged does not count.
        """
        if self.in_time is None or self.first is None or self.last is None:
            taken = np.full((len(self.rows), values.shape[1]), np.nan)
            taken[self.rows >= 0] = values[self.rows[self.rows >= 0]]
            return taken
        taken = np.full((len(self.rows), values.shape[1]), np.nan)
        for place, column in enumerate(values[self.in_time].T):
            is_known = ~np.isnan(column)
            # Sums of what is left of the mean lose no digits.
            centre = column[is_known].mean() if is_known.any() else 0.0
            sums = np.r_[0.0, np.cumsum(np.where(is_known, column - centre, 0.0))]
            counts = np.r_[0, np.cumsum(is_known)]
            n_known = counts[self.last] - counts[self.first]
            some = n_known > 0
            taken[some, place] = centre + (sums[self.last] - sums[self.first])[some] / n_known[some]
        return taken

    def others(self, column: NDArray[Any]) -> NDArray[Any]:
        """Values (n_other_rows,) of the partners (n_rows,), those of the nearest where partners are averaged; None or
        NaN where there is none.
        """
        is_there = (self.rows >= 0) & (self.rows < len(column))
        if is_there.all():
            return np.asarray(column[self.rows])
        is_number = column.dtype.kind in "fiu"
        taken = np.full(len(self.rows), np.nan if is_number else None, dtype=np.float64 if is_number else object)
        taken[is_there] = column[self.rows[is_there]]
        return taken


def by_column(own: NDArray[Any], other: NDArray[Any], names: tuple[str, str]) -> Partners:
    """Partners of equal values of a column, numbers or text; a row without a value has none. `names` are those of the
    two files.

    Raises:
        DataError: a value stands twice in the other file.
    """
    import pandas as pd

    told, others_told = ~lacks_value(own), np.flatnonzero(~lacks_value(other))
    keys, others = _comparable(own[told], other[others_told])
    twice = pd.Series(others).duplicated().to_numpy()
    if twice.any():
        raise DataError(
            f"{int(twice.sum())} values stand in several rows of it, the first: {others[np.argmax(twice)]}",
            where=f"file {names[1]}, column of `join`",
            fix="give each of its rows a value of its own, or join by time",
        )
    found = np.asarray(pd.Index(others).get_indexer(pd.Index(keys)), dtype=np.intp)
    rows = np.full(len(own), -1, dtype=np.intp)
    rows[told] = np.where(found >= 0, np.r_[others_told, -1][found], -1)
    return Partners(rows)


def by_time(own: Array, other: Array, tolerance: float, resample: str) -> Partners:
    """Partners by time, in the unit of both: the `nearest` row at most `tolerance` away, the last one before (`hold`,
    at most so old), or the `mean` of all that are at most so far away.
    """
    in_time = np.argsort(other, kind="stable")
    ordered = other[in_time]
    after = np.searchsorted(ordered, own, side="right")
    before = np.clip(after - 1, 0, len(other) - 1)
    chosen = before
    if resample != HOLD:
        later = np.clip(after, 0, len(other) - 1)
        chosen = np.where(np.abs(ordered[later] - own) < np.abs(own - ordered[before]), later, before)
    age = own - ordered[chosen]
    is_near = (np.abs(age) <= tolerance) & ((age >= 0) | (resample != HOLD))
    rows = np.where(is_near, in_time[chosen], -1)
    if resample != MEAN:
        return Partners(rows)
    first = np.searchsorted(ordered, own - tolerance, side="left")
    last = np.searchsorted(ordered, own + tolerance, side="right")
    return Partners(rows, in_time, first, np.maximum(first, last))


def seconds(name: str, column: NDArray[Any], place: Callable[[int], str]) -> Array:
    """Times (n_rows,) as numbers: dates in seconds since 1970, numbers as they are.

    Raises:
        DataError: a value is no time.
    """
    import pandas as pd

    values = times(name, column, place)
    if column.dtype == object and values.dtype.kind == "i":
        dates = pd.to_datetime(pd.Series(column).astype(str), format="ISO8601", utc=True)
        return np.asarray((dates - pd.Timestamp(0, tz="UTC")) / pd.Timedelta(seconds=1), dtype=np.float64)
    return np.asarray(values, dtype=np.float64)


def check_some(partners: Partners, own: NDArray[Any], other: NDArray[Any], names: Mapping[str, str]) -> None:
    """Some rows have a partner.

    Raises:
        DataError: none has; says what the two files hold. `names`: of the file, of the other, of the column.
    """
    if (partners.rows >= 0).any() or not len(own) or not len(other):
        return
    told = [column[~lacks_value(column)].tolist() for column in (own, other)]
    runs = [f"from {min(values)} to {max(values)}" if values else "nowhere: it is empty" for values in told]
    raise DataError(
        f"no row of it has a partner in {names['other']}: its {names['column']} runs {runs[0]}, that of the other "
        f"{runs[1]}",
        where=f"file {names['own']}, `join`",
        fix="correct `column`, or for times raise `tolerance` or bring the clocks together by `offset`",
    )


def _comparable(own: NDArray[Any], other: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Both as numbers, or both as text."""
    import pandas as pd

    as_numbers = [pd.to_numeric(pd.Series(column), errors="coerce").to_numpy(np.float64) for column in (own, other)]
    if not any(np.isnan(column).any() for column in as_numbers):
        return as_numbers[0], as_numbers[1]
    first, second = (np.array([str(value).strip() for value in column], dtype=object) for column in (own, other))
    return first, second
