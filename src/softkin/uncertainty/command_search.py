"""The commands at which a marker comes nearest to targets: bounded least squares from several starts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

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

    def nearest(self, target: Array, starts: Iterable[Array], last: Array | None, *, first_wins: bool) -> Array:
        """The command (n_commands,) of one target (3,) in mm, as of `nearest_each`."""
        return np.asarray(self.nearest_each(target[None], [starts], last, first_wins=first_wins)[0])

    def nearest_each(
        self, targets: Array, starts: Sequence[Iterable[Array]], last: Array | None, *, first_wins: bool
    ) -> Array:
        """The commands (n_targets, n_commands) that take the marker nearest to each of `targets` (n_targets, 3) in mm.

        The search of a target ends when two starts lead to the same command. Of commands that are equally good one
        in-domain is taken, and then the nearest to the last.

        Parameters:
            starts: for each target commands (n_commands,) to begin from, the most promising first.
            last: the command (n_commands,) sent before.
            first_wins: whether the first start that reaches a target ends its search.
        """
        near = None if last is None else self._share(last)
        searches = [_Search(target, map(self._share, own)) for target, own in zip(targets, starts, strict=True)]
        pending = searches
        while pending:
            begun = [(one, start) for one in pending if (start := next(one.starts, None)) is not None]
            if not begun:
                break
            some = np.array([one.target for one, _ in begun])
            shares = self._solved(some, np.array([start for _, start in begun]), near)
            for (one, start), share, far in zip(begun, shares, self._residuals(shares, some), strict=True):
                one.ends_at(start, share, far)
            pending = [one for one, _ in begun if not (one.agreed or (first_wins and one.least <= self.close_mm))]
        return np.array([self._chosen(one, near) for one in searches])

    def _chosen(self, search: _Search, last: Array | None) -> Array:
        """The command (n_commands,) of all that a search found."""
        found, residuals = search.found, search.residuals
        if search.least > self.close_mm and not search.agreed:
            share = self._probed(found[int(np.argmin(residuals))], search.target)
            search.ends_at(share, share, float(self._residuals(share[None], search.target[None])[0]))
        good = [share for share, far in zip(found, residuals, strict=True) if far <= search.least + self.close_mm]
        if len(good) > 1:
            inside = [share for share, out in zip(good, self.is_outside(self._commands(good)), strict=True) if not out]
            good = inside or good
            before = good[0] if last is None else last
            good = sorted(good, key=lambda share: float(np.linalg.norm(share - before)))
        return np.asarray(self._commands(good[:1])[0])

    def _solved(self, targets: Array, starts: Array, last: Array | None) -> Array:
        """Local solutions (n_targets, n_free) from `starts`, in shares of the bounds."""
        if not starts.shape[1]:
            return starts
        extent, weights = self.extent_mm, np.zeros(len(starts))

        def scaled(shares: Array) -> Array:
            return self.position(self._commands(shares)) / extent

        problems = Problems(scaled, targets / extent, starts, weights, self.close_mm * CLOSER / extent)
        known, slopes = problems.with_jacobian(starts, np.arange(len(starts)))
        sizes = np.linalg.svd(slopes, compute_uv=False)
        moves = sizes[:, 0] > 0
        is_redundant = moves & ((starts.shape[1] > sizes.shape[1]) | (sizes[:, -1] <= NO_EFFECT * sizes[:, 0]))
        # Held near the last command, then near what was found: what the weight costs is gone after the second time.
        weights[is_redundant] = NEARNESS
        result, near = starts.copy(), starts if last is None else np.tile(last, (len(starts), 1))
        first = np.flatnonzero(moves)
        result[first] = problems.of(first, near).solved(starts[first], (known[first], slopes[first]))
        again = np.flatnonzero(is_redundant)
        result[again] = problems.of(again, result).solved(result[again])
        return result

    def _probed(self, share: Array, target: Array) -> Array:
        """From `share` to the nearest of steps along the axes, which halve when none is nearer (Hooke and Jeeves)."""
        step, best = LARGEST_PROBE, float(self._residuals(share[None], target[None])[0])
        while step > SMALLEST_PROBE and len(share):
            probes = np.clip(np.vstack([share + step * np.eye(len(share)), share - step * np.eye(len(share))]), 0, 1)
            distances = np.linalg.norm(self.position(self._commands(probes)) - target, axis=1)
            place = int(np.argmin(distances))
            if distances[place] < best:
                share, best = probes[place], float(distances[place])
            else:
                step /= 2
        return share

    def _residuals(self, shares: Array, targets: Array) -> Array:
        """How far (n_rows,) in mm shares (n_rows, n_free) take the marker from targets (n_rows, 3)."""
        return np.asarray(np.linalg.norm(self.position(self._commands(shares)) - targets, axis=1))

    def _share(self, command: Array) -> Array:
        """Where a command lies between the bounds, from 0 to 1; of the commands that are free (n_free,)."""
        free = self.upper > self.lower
        return np.asarray(np.clip((command - self.lower)[free] / (self.upper - self.lower)[free], 0.0, 1.0))

    def _commands(self, shares: Sequence[Array] | Array) -> Array:
        """Commands (n_rows, n_commands) of shares (n_rows, n_free)."""
        free = self.upper > self.lower
        commands = np.tile(self.lower, (len(shares), 1))
        commands[:, free] += np.asarray(shares) * (self.upper - self.lower)[free]
        return np.clip(commands, self.lower, self.upper)


class _Search:
    """What was found for one target from some of its starts, in shares of the bounds."""

    def __init__(self, target: Array, starts: Iterator[Array]) -> None:
        self.target, self.starts, self.agreed = target, starts, False
        self.found: list[Array] = []
        self.residuals: list[float] = []

    @property
    def least(self) -> float:
        return min(self.residuals)

    def ends_at(self, start: Array, share: Array, residual: float) -> None:
        """A search from `start` ended at `share`, so far from the target in mm."""
        is_known = any(np.linalg.norm(share - one) <= SAME for one in self.found)
        self.agreed = not np.array_equal(share, start) and is_known
        self.found.append(share)
        self.residuals.append(float(residual))
