"""A job of the run that is watched."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass(slots=True)
class Job:
    """A job of the run.

    Attributes:
        rule: its rule.
        wildcards: its wildcards, in order.
        shipped: what it takes by the shipped timings, in seconds.
        log: its log file.
        earlier: what it took in the run before, in seconds; None where not known.
        needs: numbers of the jobs of this run whose files it reads.
        priority: of those that can start, jobs of higher priority go first.
        started: when it started, in seconds of any one clock; None: not yet.
        ended: when it ended, likewise.
        failed: whether it ended in an error.
    """

    rule: str
    wildcards: Mapping[str, str]
    shipped: float = 1.0
    log: Path | None = None
    earlier: float | None = None
    needs: Sequence[int] = ()
    priority: float = 0.0
    started: float | None = None
    ended: float | None = None
    failed: bool = False

    @property
    def stage(self) -> str:
        """Its rule in words: 'fit tuned'."""
        return self.rule.replace("_", " ")

    @property
    def name(self) -> str:
        """Its rule and wildcards in words: 'fit tuned finger gp'."""
        return " ".join([self.stage, *self.wildcards.values()])

    @property
    def taken(self) -> float | None:
        """Seconds that it took; None unless it has ended well."""
        return None if self.started is None or self.ended is None or self.failed else self.ended - self.started

    def elapsed(self, now: float) -> float | None:
        """Seconds that it has run; None unless it runs."""
        return None if self.started is None or self.ended is not None else now - self.started


def in_order(jobs: Mapping[int, Job], rules: Sequence[str]) -> dict[int, Job]:
    """The jobs in the order of their rules."""
    return dict(sorted(jobs.items(), key=lambda item: (rules.index(item[1].rule), item[0])))
