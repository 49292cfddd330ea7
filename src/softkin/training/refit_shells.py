"""Fit a few models again on inner cores of `train`: what the intervals for commands outside it start from."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.files import read_json
from softkin.core.job import stopwatch
from softkin.core.run_archive import CPU_SECONDS, RunArchive
from softkin.core.runs import Run
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, Array, Samples
from softkin.core.shells import Shells, command_norm, outer_shells
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.training.kinematic_model import fitted_model, recorded_settings, some_rows

logger = logging.getLogger("softkin")

#: A core of a smaller share of `train` says little of a model of all of it.
LEAST_CORE_SHARE = 0.2
#: Two cores whose shares differ by less say the same.
ALIKE = 0.03
#: Shared arrays of the archive: the norm of commands.
CENTRE, SCALE = "centre", "scale"


@dataclass(frozen=True, slots=True)
class ShellSettings:
    """`core_shares` of the rows of `train`; of more than `max_rows` rows of a core as many are fitted on, drawn with
    the seed; `standardised_norm` says which norm sets the dataset's extrapolation apart; each fit takes `threads`.
    """

    core_shares: Sequence[float]
    max_rows: int
    standardised_norm: bool
    seed: int
    threads: int


def core_rows(place: str) -> str:
    """Name of the shared array of the rows of a core."""
    return f"core_{place}"


def shell_rows(place: str) -> str:
    """Name of the shared array of the rows of the shell around a core."""
    return f"shell_{place}"


def refit_shells(
    table: str | Path,
    *,
    dataset: str,
    specs: Mapping[Run, ModelSpec],
    records: Mapping[Run, str | Path],
    max_fit_rows: Mapping[str, int],
    settings: ShellSettings,
    shells: str | Path,
) -> None:
    """Write `shells` (`RunArchive`), cores counted from the smallest, 0.

    Of each run and core (n_shell, n_coordinates), what the model of the core predicts of its shell, in mm. Shared by
    all runs: `core_{i}` and `shell_{i}`, rows of train; `centre` and `scale` (n_commands,) of the norm of commands;
    `fit_cpu_seconds`.

    One more core, unless another is nearly that, is as far from the edge of `train`, relatively, as that is from the
    farthest command of test and extrapolation, whose positions are not read. `records` are the runs' fit records,
    `max_fit_rows` is by model. Where all commands lie equally far out there is no shell, and the log says so.
    """
    train = read_subset(table, TRAIN)
    new = np.concatenate([read_subset(table, subset).commands for subset in (TEST, EXTRAPOLATION)])
    norm = command_norm(train.commands, standardised=settings.standardised_norm)
    parts = cores_and_shells(norm.of(train.commands), float(norm.of(new).max()), settings.core_shares)
    if not parts:
        logger.warning("%s is left out of the methods on shells: all its commands lie equally far out", dataset)
    shared: dict[str, NDArray[Any]] = {CENTRE: norm.centre, SCALE: norm.scale}
    for place, (core, shell) in enumerate(parts):
        shared |= {core_rows(str(place)): core, shell_rows(str(place)): shell}
    predictions: dict[tuple[Run, str], Array] = {}
    cpu_seconds = 0.0
    for run, spec in specs.items():
        fit_settings = recorded_settings(read_json(records[run]), settings.seed, settings.threads)
        max_rows = min(settings.max_rows, max_fit_rows.get(run.model, settings.max_rows))
        for place, (core, shell) in enumerate(parts):
            samples = some_rows(Samples(train.commands[core], train.positions[core]), max_rows, settings.seed)
            with stopwatch() as watch:
                model = fitted_model(spec, fit_settings, samples)
            cpu_seconds += watch.cpu_seconds
            predictions[run, str(place)] = np.asarray(model.predict(train.commands[shell]))
        logger.info("refitted on %d cores: %s", len(parts), " ".join(run))
    RunArchive({**shared, CPU_SECONDS: np.array(cpu_seconds)}, predictions).write(shells)


def cores_and_shells(norms: Array, farthest: float, core_shares: Sequence[float]) -> Shells:
    """Rows of each core of `train` and of its shell; `farthest` is the norm of the farthest new command.

    An empty list where the norms (n_rows,) of `train` leave no shell; no core of commands that are all 0.
    """
    reach = float(norms.max())
    matched = float(np.mean(norms <= reach * reach / farthest)) if farthest > reach else 0.0
    is_new = matched >= LEAST_CORE_SHARE and min(abs(matched - share) for share in core_shares) > ALIKE
    shares = [*core_shares, *([matched] if is_new else [])]
    if np.quantile(norms, min(shares), method="lower") == reach:
        return []
    return [(core, shell) for core, shell in outer_shells(norms, shares) if norms[core].max() > 0]
