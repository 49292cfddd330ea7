"""The command at which a marker comes nearest to a target: bounded least squares from several starts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from softkin.core.samples import Array

#: Step of finite differences, in units of each command's range: the square root of the precision of doubles is 1.5e-8.
STEP = 1e-6
#: Tolerances of least squares, and how often it evaluates the model at most.
TOLERANCE, MOST_EVALUATIONS = 1e-7, 60
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
        """The command (n_commands,) that takes the marker nearest to `target` (3,) in mm.

        The search ends when two starts lead to the same command. Of commands that are equally good one in-domain is
        taken, and then the nearest to the last.

        Parameters:
            starts: commands (n_commands,) to begin from, the most promising first.
            last: the command (n_commands,) sent before.
            first_wins: whether the first start that reaches the target ends the search.
        """
        found: list[Array] = []
        residuals: list[float] = []
        for start in map(self._share, starts):
            share = self._solved(target, start, None if last is None else self._share(last))
            agreed = not np.array_equal(share, start) and any(np.linalg.norm(share - one) <= SAME for one in found)
            found.append(share)
            residuals.append(self._residual(share, target))
            if agreed or (first_wins and residuals[-1] <= self.close_mm):
                break
        if min(residuals) > self.close_mm and not agreed:
            share = self._probed(found[int(np.argmin(residuals))], target)
            found.append(share)
            residuals.append(self._residual(share, target))
        good = [share for share, far in zip(found, residuals, strict=True) if far <= min(residuals) + self.close_mm]
        if len(good) > 1:
            inside = [share for share, out in zip(good, self.is_outside(self._commands(good)), strict=True) if not out]
            good = inside or good
            before = good[0] if last is None else self._share(last)
            good = sorted(good, key=lambda share: float(np.linalg.norm(share - before)))
        return np.asarray(self._commands(good[:1])[0])

    def _solved(self, target: Array, start: Array, last: Array | None) -> Array:
        """A local solution from `start`, in shares of the bounds."""
        if not len(start):
            return start
        problem = _Problem(self, target, None)
        sizes = np.linalg.svd(problem.jacobian(start), compute_uv=False)
        if not sizes[0] > 0:
            return start
        if len(start) <= len(sizes) and sizes[-1] > NO_EFFECT * sizes[0]:
            return self._fitted(problem, start)
        # Held near the last command, then near what was found: what the weight costs is gone after the second time.
        near = self._fitted(_Problem(self, target, start if last is None else last), start)
        return self._fitted(_Problem(self, target, near), near)

    def _fitted(self, problem: _Problem, start: Array) -> Array:
        bounds = np.zeros_like(start), np.ones_like(start)
        tolerances = {"xtol": TOLERANCE, "ftol": TOLERANCE, "gtol": TOLERANCE**1.5}
        fit = least_squares(
            problem.residuals, start, problem.jacobian, bounds, "dogbox", max_nfev=MOST_EVALUATIONS, **tolerances
        )
        return np.asarray(fit.x)

    def _probed(self, share: Array, target: Array) -> Array:
        """From `share` to the nearest of steps along the axes, which halve when none is nearer (Hooke and Jeeves)."""
        step, best = LARGEST_PROBE, self._residual(share, target)
        while step > SMALLEST_PROBE and len(share):
            probes = np.clip(np.vstack([share + step * np.eye(len(share)), share - step * np.eye(len(share))]), 0, 1)
            distances = np.linalg.norm(self.position(self._commands(probes)) - target, axis=1)
            place = int(np.argmin(distances))
            if distances[place] < best:
                share, best = probes[place], float(distances[place])
            else:
                step /= 2
        return share

    def _residual(self, share: Array, target: Array) -> float:
        return float(np.linalg.norm(self.position(self._commands([share]))[0] - target))

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


class _Problem:
    """Residuals in units of the extent, and their derivatives; both of one call of the model, at the last point asked.

    `last` (n_free,): commands are held near it, with a small weight.
    """

    def __init__(self, search: CommandSearch, target: Array, last: Array | None) -> None:
        self.search, self.target, self.last = search, target, last
        self.at: Array | None = None
        self.known: tuple[Array, Array] = (target, target)

    def residuals(self, share: Array) -> Array:
        return self._both(share)[0]

    def jacobian(self, share: Array) -> Array:
        return self._both(share)[1]

    def _both(self, share: Array) -> tuple[Array, Array]:
        if self.at is not None and np.array_equal(self.at, share):
            return self.known
        steps = np.where(share + STEP <= 1, STEP, -STEP)
        points = self.search.position(self.search._commands(np.vstack([share, share + np.diag(steps)])))
        residuals = (points[0] - self.target) / self.search.extent_mm
        jacobian = ((points[1:] - points[0]) / steps[:, None]).T / self.search.extent_mm
        if self.last is not None:
            residuals = np.concatenate([residuals, NEARNESS * (share - self.last)])
            jacobian = np.vstack([jacobian, NEARNESS * np.eye(len(share))])
        self.at, self.known = share.copy(), (residuals, jacobian)
        return self.known
