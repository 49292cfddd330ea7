"""Which terms a polynomial of the commands has, and how many of them the rows determine and the memory holds.

64 commands have 2144 terms of degree 2, 16 have 74,612 of degree 6. A fit of more terms than rows goes through every
row and says nothing between them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import comb

from softkin.core.samples import Params
from softkin.models.spec import TRENDS

#: Terms of any fit. Least squares takes time with their square: 923 terms, degree 6 of 6 commands, take seconds.
MAX_TERMS = 1000
#: Bytes of the terms of all rows of a fit; least squares holds them four times.
MAX_BYTES = 512e6


@dataclass(frozen=True, slots=True)
class Terms:
    """All products of up to `degree` of `n_commands` commands, the constant left out.

    `interaction_only` leaves out those in which a command stands twice; without `interactions` only the powers of
    single commands are left.
    """

    n_commands: int
    degree: int
    interaction_only: bool = False
    interactions: bool = True

    def __len__(self) -> int:
        """How many there are."""
        if not self.interactions:
            return self.n_commands * self.degree
        if self.interaction_only:
            return sum(comb(self.n_commands, order) for order in range(1, self.degree + 1))
        return comb(self.n_commands + self.degree, self.degree) - 1

    def __str__(self) -> str:
        """As the log names them."""
        kind = " without products of commands" if not self.interactions else ""
        return f"degree {self.degree}{kind} ({len(self)} terms)"

    def fewer(self) -> Iterator[Terms]:
        """Ever fewer terms: the degree is lowered to 2, then products of commands go, then the squares."""
        degrees = range(self.degree - 1, 0, -1)
        if self.interaction_only or not self.interactions:
            yield from (replace(self, degree=degree) for degree in degrees)
            return
        yield from (replace(self, degree=degree) for degree in degrees if degree > 1)
        if self.degree > 1:
            yield Terms(self.n_commands, 2, interactions=False)
        yield Terms(self.n_commands, 1)


def most_terms(n_rows: int) -> int:
    """Terms at most of a fit on `n_rows` rows: no more than rows, than `MAX_TERMS`, than `MAX_BYTES` hold."""
    return int(min(n_rows, MAX_TERMS, MAX_BYTES // (8 * max(n_rows, 1))))


def bounded_terms(wanted: Terms, n_rows: int) -> Terms:
    """The terms that are `wanted`, or the most of those with `fewer` that `n_rows` rows allow; the commands themselves
    always stay.
    """
    most = most_terms(n_rows)
    terms = wanted
    fewer = wanted.fewer()
    while len(terms) > most and (next_terms := next(fewer, None)) is not None:
        terms = next_terms
    return terms


def bounded_degree(params: Params, n_commands: int, n_rows: int) -> Params:
    """`params` of a model of polynomial features (`degree`, default 1, and `interaction_only`, default no), with the
    degree that a fit on `n_rows` rows has, and `interactions: False` where it has no products of commands.
    """
    wanted = Terms(n_commands, params.get("degree", 1), params.get("interaction_only", False))
    terms = bounded_terms(wanted, n_rows)
    return params if terms == wanted else {**params, "degree": terms.degree, **_without_interactions(terms)}


def bounded_trend(params: Params, n_commands: int, n_rows: int) -> Params:
    """`params` of a model on the residuals of a `trend` (default none), with the trend that a fit on `n_rows` rows has,
    and `interactions: False` where it has no products of commands.
    """
    degree = TRENDS.index(params.get("trend", TRENDS[0]))
    wanted = Terms(n_commands, degree)
    terms = bounded_terms(wanted, n_rows) if degree else wanted
    return params if terms == wanted else {**params, "trend": TRENDS[terms.degree], **_without_interactions(terms)}


def _without_interactions(terms: Terms) -> Params:
    return {} if terms.interactions else {"interactions": False}
