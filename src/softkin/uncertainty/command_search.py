"""The commands at which a marker comes nearest to targets: bounded least squares from several starts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from softkin.core.samples import Array
from softkin.uncertainty.bounded_squares import Problems

#: The search from a start ends at this share of the distance that counts as reached.
CLOSER = 1e-3
#: Weight of staying near the last command, where commands are redundant; they are when a singular value of the Jacobian
#: is less than this share of the largest.
NEARNESS, NO_EFFECT = 1e-3, 1e-4
#: Two starts that end as near to each other, in units of the range, have found the same command.
SAME = 1e-4
#: Steps of the search along the axes, which models that are constant piece by piece need, in units of the range.
LARGEST_PROBE, SMALLEST_PROBE = 0.1, 1e-4


class Starts(Protocol):
    """Commands that searches begin at, at most `n_rounds` of each target."""

    n_rounds: int

    def of_round(self, place: int, targets: NDArray[np.intp]) -> Array:
        """The commands (n_rows, n_commands) of some targets (n_rows,) in a round, from 0, NaN where there is none."""
        ...


@dataclass(frozen=True)
class CommandSearch:
    """The commands of a robot and where they take one of its markers.

    Parameters:
        position: from commands (n_rows, n_commands) to predicted positions of the marker (n_rows, 3) in mm.
        is_outside: which commands (n_rows,) lie in extrapolation.
        lower, upper: bounds (n_commands,) of commands; equal where a command is fixed.
        extent_mm: how far the marker moves: the unit of residuals.
        close_mm: targets as near as this count as reached, and commands of residuals so much alike as equally good.
    """

    position: Callable[[Array], Array]
    is_outside: Callable[[Array], NDArray[np.bool_]]
    lower: Array
    upper: Array
    extent_mm: float
    close_mm: float

    def nearest_each(self, targets: Array, starts: Starts, last: Array | None, *, first_wins: bool) -> Array:
        """The commands (n_targets, n_commands) that take the marker nearest to each of `targets` (n_targets, 3) in mm.

        The search of a target ends when two starts lead to the same command; all after the second go at once. Of
        commands that are equally good one in-domain is taken, and then the nearest to the last.

        Parameters:
            starts: commands to begin from, the most promising first.
            last: the command (n_commands,) sent before.
            first_wins: whether a first start that reaches a target ends its search.
        """
        near, found = None if last is None else self._share(last), Found(len(targets))
        pending = np.arange(len(targets))
        for rounds in np.split(np.arange(starts.n_rounds), [1, 2]):
            if not len(pending) or not len(rounds):
                break
            begun = np.stack([starts.of_round(place, pending) for place in rounds])
            places, rows = np.nonzero(~np.isnan(begun).any(axis=2))
            own, shares = pending[rows], self._share(begun[places, rows])
            ends, far = self._solved(targets[own], shares, near)
            for place in range(len(begun)):
                is_own = places == place
                found.add(own[is_own], shares[is_own], ends[is_own], far[is_own])
            is_reached = found.least[pending] <= self.close_mm
            pending = pending[~(found.agreed[pending] | (first_wins & is_reached))]
        steps = np.flatnonzero((found.least > self.close_mm) & ~found.agreed)
        if len(steps):
            probed = self._probed(found.best(steps), targets[steps])
            found.add(steps, probed, probed, self._residuals(probed, targets[steps]))
        return self._commands(self._chosen(found, near))

    def _chosen(self, found: Found, last: Array | None) -> Array:
        """Of all that was found for each target one share (n_targets, n_free)."""
        shares, residuals = found.everything()
        good = residuals <= found.least[:, None] + self.close_mm
        far = np.where(good, 0.0, np.inf)
        several = np.flatnonzero(good.sum(axis=1) > 1)
        if len(several):
            rows, places = np.nonzero(good[several])
            rows = several[rows]
            own = shares[rows, places]
            is_outside = np.zeros(good.shape, dtype=bool)
            is_outside[rows, places] = self.is_outside(self._commands(own))
            inside = good & ~is_outside
            good = np.where(inside.any(axis=1, keepdims=True), inside, good)
            before = shares[np.arange(len(good)), good.argmax(axis=1)] if last is None else last[None]
            far = np.where(good, np.linalg.norm(shares - before[:, None], axis=2), np.inf)
        return np.asarray(shares[np.arange(len(far)), far.argmin(axis=1)])

    def _solved(self, targets: Array, starts: Array, last: Array | None) -> tuple[Array, Array]:
        """Local solutions (n_targets, n_free) from `starts`, in shares of the bounds, and how far (n_targets,) in mm
        they are from the targets.
        """
        if not starts.shape[1]:
            return starts, self._residuals(starts, targets)
        extent = self.extent_mm

        def scaled(shares: Array) -> Array:
            return self.position(self._commands(shares)) / extent

        still = np.zeros(len(starts))
        problems = Problems(scaled, targets / extent, starts, still, self.close_mm * CLOSER / extent, still)
        every = np.arange(len(starts))
        known = problems.residuals(starts, every)
        slopes = problems.slopes(starts, known, every)
        is_held = np.zeros(len(starts), dtype=bool) if last is None else self._are_redundant(slopes)
        ends, missing = starts.copy(), known.copy()
        rows, held = np.flatnonzero(slopes.any(axis=(1, 2)) & ~is_held), np.flatnonzero(is_held)
        ends[rows], missing[rows] = problems.of(rows).solved(starts[rows], (known[rows], slopes[rows]))
        if last is not None and len(held):
            # Held near the last command, then near what was found: what the weight costs is gone after the second time.
            near = replace(problems.of(held), near=np.tile(last, (len(held), 1)), weights=np.full(len(held), NEARNESS))
            ends[held], _ = near.solved(starts[held], (known[held], slopes[held]))
            cautious = replace(problems.of(held), caution=np.full(len(held), NEARNESS**2))
            ends[held], missing[held] = cautious.solved(ends[held])
        return ends, extent * np.linalg.norm(missing, axis=1)

    @staticmethod
    def _are_redundant(slopes: Array) -> NDArray[np.bool_]:
        """At which of derivatives (n_rows, 3, n_free) some change of the commands has no effect, and some other has."""
        sizes = np.linalg.svd(slopes, compute_uv=False)
        has_fewer = slopes.shape[2] > sizes.shape[1]
        return np.asarray((sizes[:, 0] > 0) & (has_fewer | (sizes[:, -1] <= NO_EFFECT * sizes[:, 0])))

    def _probed(self, shares: Array, targets: Array) -> Array:
        """From `shares` (n_targets, n_free) to the nearest of steps along the axes, which halve when none is nearer
        (Hooke and Jeeves).
        """
        n_free = shares.shape[1]
        ways = np.vstack([np.eye(n_free), -np.eye(n_free)])
        shares, step, best = shares.copy(), np.full(len(shares), LARGEST_PROBE), self._residuals(shares, targets)
        rows = np.arange(len(shares) if n_free else 0)
        while len(rows):
            probes = np.clip(shares[rows, None] + step[rows, None, None] * ways, 0, 1)
            distances = self._residuals(probes.reshape(-1, n_free), targets[rows].repeat(len(ways), axis=0))
            distances = distances.reshape(len(rows), -1)
            places = distances.argmin(axis=1)
            nearest = distances[np.arange(len(rows)), places]
            is_nearer = nearest < best[rows]
            shares[rows[is_nearer]] = probes[is_nearer, places[is_nearer]]
            best[rows[is_nearer]] = nearest[is_nearer]
            step[rows[~is_nearer]] /= 2
            rows = rows[step[rows] > SMALLEST_PROBE]
        return shares

    def _residuals(self, shares: Array, targets: Array) -> Array:
        """How far (n_rows,) in mm shares (n_rows, n_free) take the marker from targets (n_rows, 3)."""
        return np.asarray(np.linalg.norm(self.position(self._commands(shares)) - targets, axis=1))

    def _share(self, commands: Array) -> Array:
        """Where commands (..., n_commands) lie between the bounds, from 0 to 1: those that are free (..., n_free)."""
        free = self.upper > self.lower
        return np.clip((commands - self.lower)[..., free] / (self.upper - self.lower)[free], 0.0, 1.0)

    def _commands(self, shares: Array) -> Array:
        """Commands (n_rows, n_commands) of shares (n_rows, n_free)."""
        free = self.upper > self.lower
        commands = np.tile(self.lower, (len(shares), 1))
        commands[:, free] += shares * (self.upper - self.lower)[free]
        return np.clip(commands, self.lower, self.upper)


class Found:
    """What searches of `n_targets` targets ended at, in shares of the bounds, round by round."""

    def __init__(self, n_targets: int) -> None:
        self.shares: list[Array] = []
        self.residuals: list[Array] = []
        self.least = np.full(n_targets, np.inf)
        self.agreed = np.zeros(n_targets, dtype=bool)

    def add(self, targets: NDArray[np.intp], starts: Array, ends: Array, residuals: Array) -> None:
        """Searches of `targets` from `starts` ended at `ends` (n_rows, n_free), so far (n_rows,) from them in mm."""
        is_known = np.zeros(len(targets), dtype=bool)
        for before in self.shares:
            is_known |= np.linalg.norm(ends - before[targets], axis=1) <= SAME
        self.agreed[targets] |= is_known & (ends != starts).any(axis=1)
        self.least[targets] = np.minimum(self.least[targets], residuals)
        everywhere, far = np.full((len(self.least), ends.shape[1]), np.nan), np.full(len(self.least), np.inf)
        everywhere[targets], far[targets] = ends, residuals
        self.shares.append(everywhere)
        self.residuals.append(far)

    def everything(self) -> tuple[Array, Array]:
        """Shares (n_targets, n_rounds, n_free), and how far (n_targets, n_rounds) from the targets in mm; NaN and
        infinite of targets that had no search in a round.
        """
        return np.stack(self.shares, axis=1), np.stack(self.residuals, axis=1)

    def best(self, targets: NDArray[np.intp]) -> Array:
        """The shares (n_rows, n_free) nearest to some of the targets."""
        shares, residuals = self.everything()
        return np.asarray(shares[targets, residuals[targets].argmin(axis=1)])
