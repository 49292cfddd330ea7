"""Cores and outer shells of `train`, which stand in for extrapolation while models are chosen and intervals made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softkin.core.errors import DataError
from softkin.core.samples import Array

Shells = list[tuple[NDArray[np.intp], NDArray[np.intp]]]


@dataclass(frozen=True, slots=True)
class CommandNorm:
    """The command norm, how far out a command lies: the norm of (command - centre) / scale, each (n_commands,)."""

    centre: Array
    scale: Array

    def of(self, commands: Array) -> Array:
        """Norms (n_rows,) of commands (n_rows, n_commands); a command of scale 0 is constant and left out."""
        varies = self.scale > 0
        return np.asarray(np.linalg.norm((commands - self.centre)[:, varies] / self.scale[varies], axis=1))


def command_norm(train_commands: Array, *, standardised: bool) -> CommandNorm:
    """The command norm of a dataset: of the raw commands, as the published data are split, or of the commands
    standardised by `train`, as softkin splits a table.
    """
    if standardised:
        return CommandNorm(train_commands.mean(axis=0), train_commands.std(axis=0))
    return CommandNorm(np.zeros(train_commands.shape[1]), np.ones(train_commands.shape[1]))


def outer_shells(norms: Array, core_shares: Sequence[float]) -> Shells:
    """(rows of the core, rows of the shell around it) for each share of rows that the core holds; ascending.

    Copies of a command have one norm (n_rows,) and stay on one side. A share that leaves core or shell empty, or
    repeats another's, is left out.

    Raises:
        DataError: all commands have the same norm.
    """
    shells: Shells = []
    for radius in sorted({float(np.quantile(norms, share, method="lower")) for share in core_shares}):
        in_core = norms <= radius
        if not in_core.all():
            shells.append((np.flatnonzero(in_core), np.flatnonzero(~in_core)))
    if not shells:
        raise DataError(
            "all commands have the same norm, so there is no outer shell",
            where="`train`",
            fix="write objective: interpolation in the configuration, and leave outer out of presets",
        )
    return shells
