"""Outer shells of `train`: what stands in for extrapolation while nothing of it may be looked at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import SoftkinError
from softkin.core.samples import Array

Shells = list[tuple[NDArray[np.intp], NDArray[np.intp]]]


@dataclass(frozen=True, slots=True)
class CommandNorm:
    """How far out a command lies: the norm of (command - centre) / scale, each (n_commands,)."""

    centre: Array
    scale: Array

    def of(self, commands: Array) -> Array:
        """Norms (n_rows,) of commands (n_rows, n_commands); a command of scale 0 never varied and counts nothing."""
        varies = self.scale > 0
        return np.asarray(np.linalg.norm((commands - self.centre)[:, varies] / self.scale[varies], axis=1))


def command_norm(train_commands: Array, *, standardised: bool) -> CommandNorm:
    """The norm by which a dataset's extrapolation lies outside: of the raw commands, as in the published data, or of
    the commands standardised by `train`, as where softkin splits a table.
    """
    if standardised:
        return CommandNorm(train_commands.mean(axis=0), train_commands.std(axis=0))
    return CommandNorm(np.zeros(train_commands.shape[1]), np.ones(train_commands.shape[1]))


def outer_shells(norms: Array, core_shares: Sequence[float]) -> Shells:
    """(rows of the core, rows of the shell around it) for each share of rows that the core holds; ascending.

    Copies of a command have one norm (n_rows,) and stay on one side. A share that leaves core or shell empty, or
    repeats another's, is left out.

    Raises:
        SoftkinError: all commands lie equally far out.
    """
    shells: Shells = []
    for radius in sorted({float(np.quantile(norms, share, method="lower")) for share in core_shares}):
        inside = norms <= radius
        if not inside.all():
            shells.append((np.flatnonzero(inside), np.flatnonzero(~inside)))
    if not shells:
        raise SoftkinError(
            "all commands of `train` lie equally far out, so it has no outer shell; mend: set tuning.objective to "
            "interpolation and leave the preset 'outer' out of presets"
        )
    return shells
