"""A fault, and the test that shows what softkin does."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """`what` goes wrong and what `happens` then, in words; `test`, below tests/, as file::name."""

    what: str
    happens: str
    test: str
