"""Compare two campaigns row by row, and tell news from noise.

A number is worse when it is worse by more than its tolerance and the difference is no chance. Rows of one command say
the same thing, so commands are compared and not rows. All comparisons of two campaigns are corrected for their number
(Holm 1979).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats

from softkin.campaigns.bootstrap import p_of_growth, p_of_growth_between
from softkin.campaigns.summary import SCORED
from softkin.core.metrics.interval import holm
from softkin.core.samples import Array
from softkin.core.units import MM

ERROR, COVERAGE, WIDTH = METRICS = ("error", "coverage", "width")
#: What is compared, in words.
TITLES = {ERROR: "mean error of a marker", COVERAGE: "coverage", WIDTH: "mean width of an interval"}
WORSE, SAME, BETTER = "worse", "same", "better"
#: With fewer distinct commands a difference is not assessed.
FEWEST = 10


@dataclass(frozen=True, slots=True)
class Tolerances:
    """From when on a difference counts.

    Parameters:
        level: chance of a false alarm in all comparisons of two campaigns together.
        error: relative growth of the mean error that is no news.
        coverage: drop of the coverage, a share, that is no news.
        width: relative growth of the mean width that is no news.
        resamples: of the bootstrap, for each comparison; more where there are so many comparisons that a p-value of
            1 / (resamples + 1) is none of them news.
    """

    level: float = 0.05
    error: float = 0.02
    coverage: float = 0.01
    width: float = 0.05
    resamples: int = 9999


@dataclass(frozen=True, slots=True)
class Comparison:
    """One number of one subset of a dataset, before and now. `p_worse` and `p_better` are corrected; `paired` says
    whether the same rows were scored both times, `n_commands` how many distinct commands now; `unit` is that of errors
    and widths.
    """

    dataset: str
    subset: str
    metric: str
    before: float
    now: float
    n_commands: int
    paired: bool
    p_worse: float
    p_better: float
    outcome: str = SAME
    unit: str = MM

    @property
    def title(self) -> str:
        """What the number is: 'mean error of a marker, mm'."""
        return TITLES[self.metric] if self.metric == COVERAGE else f"{TITLES[self.metric]}, {self.unit}"

    def as_dict(self) -> dict[str, Any]:
        """For JSON, without numbers that JSON has none for."""
        values = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in values.items()}


def compare(
    before: pd.DataFrame,
    now: pd.DataFrame,
    *,
    confidence_level: float,
    calibration_rows: Mapping[str, int],
    tolerances: Tolerances,
    units: Mapping[str, str] | None = None,
    seed: int = 0,
) -> list[Comparison]:
    """The comparisons of the datasets that both campaigns scored.

    Parameters:
        before, now: rows as `summarise` writes them.
        confidence_level: nominal level of the intervals, in (0, 1).
        calibration_rows: dataset -> rows of its `validation` now.
        tolerances: from when on a difference counts.
        units: dataset -> unit of its errors and widths; mm where it has none.
        seed: of the bootstrap.
    """
    found, shared = [], [name for name in now["dataset"].unique() if name in set(before["dataset"])]
    n_comparisons = len(shared) * len(SCORED) * len(METRICS)
    needed = math.ceil(2 * n_comparisons / tolerances.level)
    tolerances = replace(tolerances, resamples=max(tolerances.resamples, needed))
    for dataset in shared:
        for subset in SCORED:
            old, new = (_Commands.of(rows, dataset, subset) for rows in (before, now))
            if len(old) and len(new):
                law = _Law(confidence_level, calibration_rows[dataset])
                found += _of_subset((dataset, subset), old, new, law, tolerances, seed)
    return [replace(one, unit=(units or {}).get(one.dataset, MM)) for one in judged(found, tolerances)]


def judged(comparisons: Sequence[Comparison], tolerances: Tolerances) -> list[Comparison]:
    """The comparisons with corrected p-values and their outcomes."""
    if not comparisons:
        return []
    worse = holm(np.array([one.p_worse for one in comparisons]))
    better = holm(np.array([one.p_better for one in comparisons]))
    corrected = [
        replace(c, p_worse=float(w), p_better=float(b)) for c, w, b in zip(comparisons, worse, better, strict=True)
    ]
    return [replace(one, outcome=_outcome(one, tolerances)) for one in corrected]


@dataclass(frozen=True, slots=True)
class _Law:
    """The law of how many rows an interval of this level covers, calibrated on this many rows: beta-binomial."""

    level: float
    n_calibration: int

    def p_of_so_few(self, n_covered: int, n_rows: int) -> float:
        rank = min(math.ceil((self.n_calibration + 1) * self.level), self.n_calibration)
        return float(stats.betabinom(n_rows, rank, self.n_calibration + 1 - rank).cdf(n_covered))


@dataclass(frozen=True, slots=True)
class _Commands:
    """The distinct commands of a subset, in the order of their names: means of their rows, and their first rows."""

    names: list[str]
    rows: list[str]
    error_mm: Array
    width_mm: Array
    hits: NDArray[np.bool_]

    @classmethod
    def of(cls, rows: pd.DataFrame, dataset: str, subset: str) -> _Commands:
        """Those of a subset among the rows of a campaign."""
        part = rows[(rows["dataset"] == dataset) & (rows["subset"] == subset)]
        names, first, place = np.unique(part["command"].to_numpy(str), return_index=True, return_inverse=True)
        counts = np.bincount(place)
        error, width = (np.bincount(place, part[name].to_numpy(float)) / counts for name in ("error_mm", "width_mm"))
        covered = part["covered"].to_numpy(object)[first]
        hits = np.array([[digit == "1" for digit in text] for text in covered], dtype=np.bool_)
        return cls(names.tolist(), sorted(part["row"]), error, width, hits)

    def __len__(self) -> int:
        return len(self.names)


def _of_subset(
    place: tuple[str, str], old: _Commands, new: _Commands, law: _Law, tolerances: Tolerances, seed: int
) -> list[Comparison]:
    paired = old.rows == new.rows
    made = []
    for metric, one, other in ((ERROR, old.error_mm, new.error_mm), (WIDTH, old.width_mm, new.width_mm)):
        worse, better = _grown(one, other, paired, tolerances, seed), _grown(other, one, paired, tolerances, seed)
        made.append(Comparison(*place, metric, float(one.mean()), float(other.mean()), len(new), paired, worse, better))
    if old.hits.shape[1] == new.hits.shape[1]:
        drops = [_dropped(a, b, paired, law) for a, b in zip(old.hits.T, new.hits.T, strict=True)]
        shares = (float(old.hits.mean()), float(new.hits.mean()))
        made.append(Comparison(*place, COVERAGE, *shares, len(new), paired, min(1.0, len(drops) * min(drops)), 1.0))
    return made if min(len(old), len(new)) >= FEWEST else [replace(one, p_worse=1.0, p_better=1.0) for one in made]


def _grown(before: Array, now: Array, paired: bool, tolerances: Tolerances, seed: int) -> float:
    """p-value of the mean being no larger than before; infinite values are larger than all others."""
    if np.isinf(now).sum() != np.isinf(before).sum():
        return 1.0 / (tolerances.resamples + 1) if np.isinf(now).sum() > np.isinf(before).sum() else 1.0
    finite = np.isfinite(before) & np.isfinite(now) if paired else None
    if finite is not None:
        return p_of_growth((now - before)[finite], resamples=tolerances.resamples, seed=seed) if finite.any() else 1.0
    one, other = before[np.isfinite(before)], now[np.isfinite(now)]
    return (
        p_of_growth_between(one, other, resamples=tolerances.resamples, seed=seed) if len(one) and len(other) else 1.0
    )


def _dropped(before: NDArray[np.bool_], now: NDArray[np.bool_], paired: bool, law: _Law) -> float:
    """p-value of one coordinate being covered as often as before, or as often as its level says: the larger of both.

    Paired rows: the exact test of McNemar (1947), by the rows that only one interval covers; else Fisher's exact test.
    """
    if paired:
        lost, won = int((before & ~now).sum()), int((now & ~before).sum())
        drop = float(stats.binomtest(lost, lost + won, 0.5, "greater").pvalue) if lost + won else 1.0
    else:
        table = [[now.sum(), (~now).sum()], [before.sum(), (~before).sum()]]
        drop = float(stats.fisher_exact(table, "less").pvalue)
    return max(drop, law.p_of_so_few(int(now.sum()), len(now)))


def _outcome(one: Comparison, tolerances: Tolerances) -> str:
    if one.metric == COVERAGE:
        return WORSE if one.p_worse <= tolerances.level and one.before - one.now > tolerances.coverage else SAME
    tolerance = tolerances.error if one.metric == ERROR else tolerances.width
    if one.p_worse <= tolerances.level and one.now > one.before * (1 + tolerance):
        return WORSE
    if one.p_better <= tolerances.level and one.now * (1 + tolerance) < one.before:
        return BETTER
    return SAME
