"""Parameters of a trial that mean the same in the fit on all rows: bounded by what the fewest rows of a part allow."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TYPE_CHECKING

from softkin.core.folds import Folds
from softkin.core.samples import Params
from softkin.models.quantile.spec import QuantileSpec
from softkin.models.spec import ModelSpec

if TYPE_CHECKING:
    from optuna.trial import Trial

logger = logging.getLogger("softkin")


def bounded_space(spec: ModelSpec | QuantileSpec, n_commands: int, parts: Folds) -> Callable[[Trial], Params]:
    """Draws the parameters of a trial, as `spec.bounded` leaves them by the fewest rows that are fitted on.

    A fit on all rows may have more terms than one on a part: it would get a polynomial that no trial has scored. The
    log says once what the parameters become.

    Parameters:
        spec: the model, or the quantile regressor.
        n_commands: number of commands.
        parts: of each part of `train` the rows that are fitted on, and those that are scored.
    """
    n_rows = min(len(fitted) for fitted, _ in parts)
    said: set[str] = set()

    def space(trial: Trial) -> Params:
        drawn = spec.search_space(trial)
        bounded = spec.bounded(drawn, n_commands, n_rows)
        changes = ", ".join(f"{name} is {value}" for name, value in bounded.items() if drawn.get(name) != value)
        if changes and changes not in said:
            said.add(changes)
            logger.warning("trials of %d rows allow fewer terms of %d commands: %s", n_rows, n_commands, changes)
        return bounded

    return space
