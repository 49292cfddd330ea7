"""The specification of a claim of the paper, and its verdict from what a run measured."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from softkin.reporting.claims.measured import Measured

HOLDS, HOLDS_WITH, DOES_NOT, NOT_ASSESSABLE = VERDICTS = (
    "holds",
    "holds with these settings",
    "does not hold",
    "not assessable",
)


@dataclass(frozen=True, slots=True)
class Case:
    """One comparison: with which `setting` (a preset, a level, `as printed`), at which `place` (a dataset, and a subset
    where there is one), whether the claim `holds` there, and the `number` that decides.
    """

    setting: str
    place: str
    holds: bool
    number: str


@dataclass(frozen=True, slots=True)
class ClaimSpec:
    """One claim: what the paper says (`text`) and `where`; `rule(measured)` returns the cases that decide it, and
    `rule_text` says what is compared; `table` is the file of results/tables that holds the numbers.

    It holds with a setting where all cases of it hold, or with `most` more than half of them. Cases at fewer than
    `robots` datasets decide nothing: then `missing` says what the run lacks.
    """

    name: str
    text: str
    where: str
    rule: Callable[[Measured], Iterable[Case]]
    rule_text: str
    table: str
    missing: str
    most: bool = False
    robots: int = 1


@dataclass(frozen=True, slots=True)
class Judged:
    """A `verdict`, the settings with which the claim holds, and the cases that decided."""

    verdict: str
    settings: tuple[str, ...]
    cases: tuple[Case, ...]


def judged(claim: ClaimSpec, measured: Measured) -> Judged:
    """The verdict of a claim: with all settings of its cases, with some, with none; or that there are too few cases."""
    cases = tuple(claim.rule(measured))
    if len({case.place.split()[0] for case in cases}) < claim.robots:
        return Judged(NOT_ASSESSABLE, (), ())
    settings = dict.fromkeys(case.setting for case in cases)
    with_which = tuple(setting for setting in settings if _holds(claim, cases, setting))
    if not with_which:
        return Judged(DOES_NOT, (), cases)
    return Judged(HOLDS if len(with_which) == len(settings) else HOLDS_WITH, with_which, cases)


def _holds(claim: ClaimSpec, cases: Sequence[Case], setting: str) -> bool:
    votes = [case.holds for case in cases if case.setting == setting]
    return sum(votes) > len(votes) / 2 if claim.most else all(votes)
