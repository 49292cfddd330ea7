"""An alarm fed pose by pose: a conformal test martingale that grows when poses stop being like those calibrated on.

While poses are exchangeable with the calibration set, p-values are independent and uniform, and by Ville's inequality
the martingale reaches 1 / rate with a probability of at most `rate`, however long one watches (Vovk, Gammerman and
Shafer 2005, section 7.1). Where only blocks of poses are exchangeable that does not hold, and the watch says so. Signed
errors make it see a shifted zero at once. Bets are those of crepes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from softkin.core.samples import Array
from softkin.uncertainty.conformal import p_values
from softkin.uncertainty.promise import Promise, worth_of_alarm

#: Share of the capital that changes its bet at each pose.
JUMP = 0.01


@dataclass(frozen=True, slots=True)
class Alarm:
    """Exchangeability broke: noticed at the `pose` of this number (from 1), mostly in these `coordinates`, at this
    value of the `martingale`.
    """

    pose: int
    coordinates: tuple[str, ...]
    martingale: float


class Watch:
    """Watches poses for a break of exchangeability, at a `rate` of false alarms over all time.

    Parameters:
        calibration_errors: measured minus predicted positions (n_calibration, n_coordinates) in mm.
        names: of the coordinates.
        rate: how often a watch that has no reason may ever raise an alarm.
        seed: of the smoothing of p-values.
        error: error(command, position), measured minus predicted position (n_coordinates,), asked once for each pose in
            turn; None where errors are given.
        promise: of the calibration set, where blocks are exchangeable and not rows: `worth` then says that the rate is
            no guarantee; None: it is one.
    """

    def __init__(
        self,
        calibration_errors: Array,
        names: Sequence[str],
        rate: float = 0.01,
        seed: int = 0,
        error: Callable[[Any, Any], Array] | None = None,
        promise: Promise | None = None,
    ) -> None:
        from crepes.martingales import StepBettingFunction

        self.errors, self.names, self.rate, self.error = calibration_errors, tuple(names), rate, error
        self.p_values = np.empty((0, len(self.names)))
        self.alarm: Alarm | None = None
        self.worth = worth_of_alarm(promise)
        self._rng = np.random.default_rng(seed)
        self._bets = StepBettingFunction()
        n_bets = self._bets.apply(np.array([0.5])).shape[1]
        self._capital = np.full((len(self.names), n_bets), 1 / n_bets)

    def see(self, command: Any, position: Any) -> Alarm | None:
        """The alarm, if there is one by now, after the `position` (mm) measured at `command`; both are vectors."""
        assert self.error is not None
        return self.judge(self.error(command, position))

    def judge(self, error: Array) -> Alarm | None:
        """The same, given measured minus predicted position (n_coordinates,) in mm."""
        new = p_values(self.errors, error[None], rng=self._rng)
        self.errors, self.p_values = np.vstack([self.errors, error]), np.vstack([self.p_values, new])
        self._capital *= self._bets.apply(new[0])
        last = self._capital.sum(axis=1)
        # The update of crepes' SimpleJumper, which starts anew with each call.
        self._capital = (1 - JUMP) * self._capital + JUMP * last[:, None] / self._capital.shape[1]
        # The mean of martingales is one, however they depend on each other.
        if self.alarm is None and last.mean() >= 1 / self.rate:
            grown = [name for name, value in zip(self.names, last, strict=True) if value >= 1 / self.rate]
            self.alarm = Alarm(len(self.p_values), tuple(grown), float(last.mean()))
        return self.alarm
