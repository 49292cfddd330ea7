"""Refit a few models on inner cores of `train`, for the intervals in extrapolation."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softkin.core.clocks import stopwatch
from softkin.core.failed_parts import MODELS, of_part
from softkin.core.files import read_json
from softkin.core.run_archive import CPU_SECONDS, RunArchive
from softkin.core.runs import Run
from softkin.core.samples import EXTRAPOLATION, TEST, TRAIN, Array
from softkin.core.shells import Shells, command_norm, outer_shells
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.training.bounded_rows import some_rows
from softkin.training.kinematic_model import fitted_model, recorded_settings
from softkin.training.members import Weights, combined

logger = logging.getLogger("softkin")

#: Share of `train` that the matched core holds at least: a model of fewer rows is too unlike a model of all.
LEAST_CORE_SHARE = 0.2
#: The matched core is left out where its share differs from a configured one by no more than this.
ALIKE = 0.03
#: Shared arrays of the archive: the norm of commands.
CENTRE, SCALE = "centre", "scale"


@dataclass(frozen=True, slots=True)
class ShellSettings:
    """Cores hold `core_shares` of the rows of `train`; a fit takes `max_rows` of a core at most, drawn with the `seed`,
    and `threads` threads at most; `standardised_norm` says that the command norm is that of standardised commands.
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
    weights: Mapping[Run, Weights] | None = None,
) -> None:
    """Write what the refit of each run on each core predicts of the shell around the core.

    The archive holds, of each run and core (n_shell, n_coordinates) in mm, cores counted from the smallest, 0. Shared
    by all runs: `core_{i}` and `shell_{i}`, rows of train; `centre` and `scale` (n_commands,) of the command norm;
    `fit_cpu_seconds`. Of test and extrapolation commands are read and no positions. Where all commands have the same
    norm there is no shell, and the log says so.

    Parameters:
        table: path of the tidy table (Parquet).
        dataset: its name, for the log.
        specs: the model of each run.
        records: path of the fit record (JSON) of each run: a refit has the parameters of the fit.
        max_fit_rows: rows of a fit at most, by model; a model that is missing takes any number.
        settings: cores, seed and threads.
        shells: path of the archive (`RunArchive`).
        weights: the runs that are written, each the weighted mean of these `specs`; None: all of `specs`.
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
        own = max_fit_rows.get(run.model, settings.max_rows)
        bound = (own, "max_fit_rows") if own < settings.max_rows else (settings.max_rows, "shells.max_rows")
        for place, (core, shell) in enumerate(parts):
            samples = some_rows(train.take(core), bound[0], settings.seed, bound[1])
            with of_part(MODELS, run.model), stopwatch() as watch:
                model = fitted_model(spec, fit_settings, samples)
            cpu_seconds += watch.cpu_seconds
            predictions[run, str(place)] = np.asarray(model.predict(train.take(shell).inputs))
        logger.info("refitted on %d cores: %s", len(parts), " ".join(run))
    written = predictions if weights is None else combined(predictions, weights)
    RunArchive({**shared, CPU_SECONDS: np.array(cpu_seconds)}, written).write(shells)


def cores_and_shells(norms: Array, farthest: float, core_shares: Sequence[float]) -> Shells:
    """Rows of each core of `train` and of its shell, by the norms (n_rows,) of its commands.

    To the cores of `core_shares` comes the matched one, unless another is nearly that: the largest norm of `train` is
    to its norm as `farthest`, the norm of the farthest new command, is to the largest of `train`. So intervals made of
    these shells are transductive: all new commands, none of their positions, were looked at. The list is empty
    where the norms leave no shell; a core of commands that are all 0 is left out.
    """
    largest = float(norms.max())
    matched = float(np.mean(norms <= largest * largest / farthest)) if farthest > largest else 0.0
    is_new = matched >= LEAST_CORE_SHARE and min(abs(matched - share) for share in core_shares) > ALIKE
    shares = [*core_shares, *([matched] if is_new else [])]
    if np.quantile(norms, min(shares), method="lower") == largest:
        return []
    return [(core, shell) for core, shell in outer_shells(norms, shares) if norms[core].max() > 0]
