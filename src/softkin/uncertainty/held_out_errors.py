"""Difficulties of searched runs, by what their studies stored of held-out folds of `train`: nothing is fitted again."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from softkin.core.rows import sampled_rows
from softkin.core.runs import TUNED, Run
from softkin.core.samples import Array, Samples, informative_coordinates
from softkin.models.estimators.weighted_mean import weighted_sum
from softkin.training.held_out import PartSettings, Robot, parts_of, read_held_out, truth_of
from softkin.training.members import all_members, members_of_runs
from softkin.uncertainty.held_out_difficulty import HeldOutDifficulty, fit_difficulty


def difficulties(
    train: Samples, settings: PartSettings, held_out: Mapping[Run, str | Path], records: Mapping[Run, str | Path]
) -> dict[Run, HeldOutDifficulty]:
    """The difficulty of commands for each run of `records`; one without predictions of its held-out rows has none.

    Parameters:
        train: the rows of `train`.
        settings: by which studies drew rows, markers and folds.
        held_out: run -> file of what a searched model predicts of held-out rows; ensembles have none of their own.
        records: run -> record (JSON) of its fit, which names the members of an ensemble.
    """
    column = _column_of_coordinates(train, parts_of(train, settings, Robot(None, False))[0], settings)
    found = {}
    for run, (commands, errors) in held_out_errors(train, settings, held_out, records).items():
        typical = errors.mean(axis=0)
        shared = (errors / np.where(typical > 0, typical, 1.0)).mean(axis=1)
        found[run] = fit_difficulty(commands, np.column_stack([errors, shared]), column)
    return found


def held_out_errors(
    train: Samples, settings: PartSettings, held_out: Mapping[Run, str | Path], records: Mapping[Run, str | Path]
) -> dict[Run, tuple[Array, Array]]:
    """Commands (n_rows, n_commands) of held-out rows and absolute errors (n_rows, n_scored) in mm there, by run; the
    arguments are as of `difficulties`.
    """
    rows, parts = parts_of(train, settings, Robot(None, False))
    truth = np.concatenate(truth_of(rows, parts[TUNED]))
    commands = rows.commands[np.concatenate([scored for _, scored in parts[TUNED]])]
    weights = members_of_runs(records, records)
    stored = {run: read_held_out(held_out[run]) for run in all_members(weights)}
    predicted = {run: of_run[TUNED] for run, of_run in stored.items() if TUNED in of_run}
    found = {}
    for run, members in weights.items():
        if members.keys() <= predicted.keys():
            mean = weighted_sum([predicted[member] for member in members], list(members.values()))
            found[run] = commands, np.abs(truth - mean)
    return found


def _column_of_coordinates(train: Samples, rows: Samples, settings: PartSettings) -> NDArray[np.int64]:
    """The column of errors of each coordinate (n_coordinates,) of `train`: those that studies scored have their own,
    other moving ones the last, -1 is that of none.
    """
    drawn = train.positions[sampled_rows(len(train), settings.max_rows, settings.seed)]
    scored = rows.positions[:, informative_coordinates(rows.positions)]
    column = np.where(informative_coordinates(train.positions), scored.shape[1], -1)
    for place, values in enumerate(scored.T):
        column[(drawn == values[:, None]).all(axis=0)] = place
    return column.astype(np.int64)
