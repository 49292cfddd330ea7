"""What people say of chance and of time, checked: random generators, seeds, sessions of a recording."""

from __future__ import annotations

from collections.abc import Collection
from numbers import Integral, Real
from typing import Any

import numpy as np

from softkin.core.errors import ConfigError, DataError
from softkin.uncertainty.calls import level_of


def check_generator(rng: Any, where: str) -> None:
    """A random generator of NumPy, or None.

    Raises:
        ConfigError: it is another thing, such as a seed.
    """
    if rng is not None and not isinstance(rng, np.random.Generator):
        raise ConfigError(
            f"{rng!r} is no random generator", where=where, fix="pass numpy.random.default_rng(seed), or leave it out"
        )


def check_seed(seed: Any, where: str) -> None:
    """A whole number that is not negative.

    Raises:
        ConfigError: it is another thing.
    """
    if not isinstance(seed, Integral) or isinstance(seed, bool) or seed < 0:
        raise ConfigError(f"{seed!r} is no seed", where=where, fix="pass a whole number, such as 0")


def rate_of(rate: Any, seed: Any, where: str) -> float:
    """The rate of false alarms of a watch, whose p-values are smoothed by a seed.

    Raises:
        ConfigError: no rate between 0 and 1, or no seed.
    """
    check_seed(seed, where)
    return level_of(rate, where, "rate of false alarms")


def session_of(session: Any, known: Collection[float], where: str) -> float:
    """The number of a session of a recording.

    Raises:
        DataError: there is no such session.
    """
    is_number = isinstance(session, Real) and not isinstance(session, (bool, np.bool_))
    if not is_number or float(session) not in known:
        raise DataError(
            f"no session {session} in its recording ({[int(number) for number in known]})",
            where=where,
            fix="leave the session out; a new one has the average zero until it is recalibrated",
        )
    return float(session)
