"""Fit a few models again on inner cores of `train`: what the intervals for commands outside it start from."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from softkin.datasets.table import read_subset
from softkin.files import read_json, replacing
from softkin.fitting import some_rows
from softkin.interface import EXTRAPOLATION, TEST, TRAIN, Array, ModelSpec, Samples
from softkin.job import stopwatch
from softkin.refitting import refitted
from softkin.shells import Shells, command_norm, outer_shells

logger = logging.getLogger("softkin")

#: A core of a smaller share of `train` says little of a model of all of it.
LEAST_CORE_SHARE = 0.2
#: Two cores whose shares differ by less say the same.
ALIKE = 0.03


@dataclass(frozen=True, slots=True)
class ShellSettings:
    """`core_shares` of the rows of `train`; of more than `max_rows` rows of a core as many are fitted on, drawn with
    the seed.
    """

    core_shares: Sequence[float]
    max_rows: int
    seed: int


def refit_shells(
    table: str | Path,
    *,
    dataset: str,
    standardised: bool,
    specs: Mapping[tuple[str, str], ModelSpec],
    records: Mapping[tuple[str, str], str | Path],
    max_fit_rows: Mapping[str, int],
    settings: ShellSettings,
    threads: int,
    shells: str | Path,
) -> None:
    """Write `shells` (NumPy archive), cores counted from the smallest:

    `core_{i}` and `shell_{i}`, rows of train; `{model}/{preset}/{i}` (n_shell, n_coordinates), what the model of the
    core predicts of its shell, in mm; `centre` and `scale` (n_commands,) of the norm of commands; `fit_cpu_seconds`.

    `standardised` says which norm sets the dataset's extrapolation apart. One more core, unless another is nearly that,
    is as far from the edge of `train`, relatively, as that is from the farthest command of test and extrapolation,
    whose positions are not read. `records` are the runs' fit records, `max_fit_rows` is by model. Where all commands
    lie equally far out there is no shell, and the log says so.
    """
    train = read_subset(table, TRAIN)
    new = np.concatenate([read_subset(table, subset).commands for subset in (TEST, EXTRAPOLATION)])
    norm = command_norm(train.commands, standardised=standardised)
    parts = cores_and_shells(norm.of(train.commands), float(norm.of(new).max()), settings.core_shares)
    if not parts:
        logger.warning("%s is left out of the methods on shells: all its commands lie equally far out", dataset)
    arrays: dict[str, Array | NDArray[np.intp]] = {"centre": norm.centre, "scale": norm.scale}
    for place, (core, shell) in enumerate(parts):
        arrays |= {f"core_{place}": core, f"shell_{place}": shell}
    cpu_seconds = 0.0
    for run, spec in specs.items():
        record = read_json(records[run])
        max_rows = min(settings.max_rows, max_fit_rows.get(run[0], settings.max_rows))
        for place, (core, shell) in enumerate(parts):
            samples = some_rows(Samples(train.commands[core], train.positions[core]), max_rows, settings.seed)
            with stopwatch() as watch:
                estimator = refitted(spec, record, samples, seed=settings.seed, threads=threads)
            cpu_seconds += watch.cpu_seconds
            arrays["/".join((*run, str(place)))] = np.asarray(estimator.predict(train.commands[shell]))
        logger.info("refitted on %d cores: %s", len(parts), " ".join(run))
    arrays["fit_cpu_seconds"] = np.array(cpu_seconds)
    with replacing(shells) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, **arrays)  # type: ignore[arg-type]


def cores_and_shells(norms: Array, farthest: float, core_shares: Sequence[float]) -> Shells:
    """Rows of each core of `train` and of its shell; `farthest` is the norm of the farthest new command.

    None where the norms (n_rows,) of `train` leave no shell; no core of commands that are all 0.
    """
    reach = float(norms.max())
    matched = float(np.mean(norms <= reach * reach / farthest)) if farthest > reach else 0.0
    is_new = matched >= LEAST_CORE_SHARE and min(abs(matched - share) for share in core_shares) > ALIKE
    shares = [*core_shares, *([matched] if is_new else [])]
    if np.quantile(norms, min(shares), method="lower") == reach:
        return []
    return [(core, shell) for core, shell in outer_shells(norms, shares) if norms[core].max() > 0]
