"""Score a model in time: on the published split, in sessions never seen, and later in the same recording.

Sessions never seen and later rows are in-domain rows of the recording: `train`, `validation` and `test`, in the order
of time. For each, the model of a run is fitted anew with its parameters, with its memory and without, on the rows
before; a fifth of these, in stretches of time, is held out to calibrate on. Truth of the rows that are scored is used
by recalibration, which labels a few of them, and by intervals that take rows in turn, and by nothing else.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
import pandas as pd

from softkin.core.csv_tables import write_csv
from softkin.core.folds import folds_of
from softkin.core.metrics.interval import covered, widths, winkler_scores
from softkin.core.recording import Recording
from softkin.core.rows import Indices
from softkin.core.runs import Run
from softkin.core.samples import (
    EXTRAPOLATION,
    SUBSETS,
    TEST,
    TRAIN,
    VALIDATION,
    Array,
    Samples,
    informative_coordinates,
)
from softkin.data.table import read_subset
from softkin.evaluation.intervals_in_time import after, among, blocks
from softkin.evaluation.recorded_names import (
    BLOCKS,
    COLUMNS,
    FIRST_POSES,
    LATER,
    NEXT_SESSION,
    PLAIN,
    PUBLISHED,
    RECALIBRATED,
)
from softkin.models.estimators.memory_features import MEMORIES, NONE
from softkin.models.estimators.weighted_mean import weighted_mean
from softkin.models.spec import ModelSpec
from softkin.training.bounded_rows import some_rows
from softkin.training.kinematic_model import STATIC, FitSettings, fitted_model
from softkin.uncertainty.conformal import around, conformal_limits
from softkin.uncertainty.new_session import zero_spread
from softkin.uncertainty.recalibration import recalibration

N_POSES, N_DRAWS, N_FOLDS, LATER_SHARE = (5, 10, 20), 200, 5, 0.8


@dataclass(frozen=True, slots=True)
class Member:
    """A member of a run: its `spec`, the `settings` of its fit, its `weight`, the rows that it is fitted on at most."""

    spec: ModelSpec
    settings: FitSettings
    weight: float
    max_rows: int | None = None


@dataclass(frozen=True, slots=True)
class RecordedRun:
    """A run on a recording, the mean of its `members`; draws are seeded, intervals at a `confidence_level`."""

    run: Run
    members: Sequence[Member]
    seed: int
    confidence_level: float

    def fitted(self, samples: Samples) -> Any:
        """The regressor of this run, fitted on `samples`, or as many of them as a member takes."""
        models = [fitted_model(m.spec, m.settings, some_rows(samples, m.max_rows, self.seed)) for m in self.members]
        weights, names = [member.weight for member in self.members], [member.spec.name for member in self.members]
        return weighted_mean(models, weights, names)

    def memory(self) -> str:
        """What the member is told that is told most of the commands before."""
        told = [str((member.settings.memory or STATIC)["memory"]) for member in self.members]
        return max(told, key=MEMORIES.index)

    def without_memory(self) -> Self:
        """The same run, told the command alone."""
        static = [replace(member, settings=replace(member.settings, memory=STATIC)) for member in self.members]
        return replace(self, members=static)


@dataclass(frozen=True, slots=True)
class Part:
    """What a fitted model errs by, measured minus predicted position (n_rows, n_coordinates) in mm, moving coordinates
    alone: on rows to calibrate on and on new ones, both in the order of time.
    """

    known: Array
    new: Array
    spread: Array | None


def score_recorded(table: str | Path, *, dataset: str, run: RecordedRun | None, output: str | Path) -> None:
    """Write the scores of a run in time (CSV, columns as in `recorded_names`), mm; without a recording or a run none.

    Coverage, width and Winkler score are means over moving coordinates. Of `N_DRAWS` draws of labelled poses, means.

    Parameters:
        table: path of the tidy table (Parquet).
        dataset: its name.
        run: the run that is scored; None where none is deployed.
        output: path of the scores.
    """
    samples = {subset: read_subset(table, subset) for subset in SUBSETS}
    rows: list[dict[str, Any]] = []
    if run is not None and samples[TRAIN].recording is not None:
        for memory, of_memory in {NONE: run.without_memory(), run.memory(): run}.items():
            key = {"dataset": dataset, "model": run.run.model, "preset": run.run.preset, "memory": memory}
            rows += [key | row for row in scored(samples, of_memory)]
    write_csv(output, pd.DataFrame(rows, columns=COLUMNS))


def scored(samples: Mapping[str, Samples], run: RecordedRun) -> Iterator[dict[str, Any]]:
    """The rows of one memory: split, subset, method and scores."""
    level = run.confidence_level
    model = run.fitted(samples[TRAIN])
    moving = informative_coordinates(samples[TRAIN].positions)
    errors = {name: (rows.positions - model.predict(rows.inputs))[:, moving] for name, rows in samples.items()}
    for subset in (TEST, EXTRAPOLATION):
        yield {"split": PUBLISHED, "subset": subset} | plain(Part(errors[VALIDATION], errors[subset], None), level)
    yield from by_session(samples, errors, level)
    rows = in_time([samples[subset] for subset in (TRAIN, VALIDATION, TEST)])
    assert rows.recording is not None
    first = np.arange(len(rows)) < LATER_SHARE * len(rows)
    yield from over_time(LATER, f"last {1 - LATER_SHARE:.0%}", part(rows.take(first), rows.take(~first), run), level)
    session = rows.recording.session
    for known, new in next_sessions(sorted(set(session.tolist()))):
        name = f"{new} after {'+'.join(map(str, known))}"
        of_part = part(rows.take(np.isin(session, known)), rows.take(session == new), run)
        yield from over_time(NEXT_SESSION, name, of_part, level)
        yield from relabelled(name, of_part, level, run.seed)


def next_sessions(sessions: list[int]) -> list[tuple[list[int], int]]:
    """(sessions fitted on, the session that is scored): the first alone before each other, and all before the last."""
    pairs = [(sessions[:1], new) for new in sessions[1:]]
    return pairs + ([(sessions[:-1], sessions[-1])] if len(sessions) > 2 else [])


def in_time(parts: list[Samples]) -> Samples:
    """Rows of several subsets in the order of their recording."""
    known = [each.recording for each in parts if each.recording is not None]
    order, session = (np.concatenate([getattr(each, name) for each in known]) for name in ("order", "session"))
    recording = Recording(order, session, np.concatenate([each.memory for each in known]), known[0].robot)
    commands, positions = (
        np.concatenate([getattr(each, name) for each in parts]) for name in ("commands", "positions")
    )
    return Samples(commands, positions, recording).take(np.argsort(order, kind="stable"))


def part(before: Samples, after: Samples, run: RecordedRun) -> Part:
    """Errors of the model fitted on rows before, on those held out of them and on the rows after."""
    fitted_rows, held_out = folds_of(before, N_FOLDS, run.seed)[0]
    model = run.fitted(before.take(fitted_rows))
    moving = informative_coordinates(before.positions)
    known, new = (
        (rows.positions - model.predict(rows.inputs))[:, moving] for rows in (before.take(np.sort(held_out)), after)
    )
    spread = zero_spread(model)
    return Part(known, new, None if spread is None else spread[moving])


def scores(errors: Array, halves: Array, level: float) -> dict[str, float]:
    """Scores of symmetric intervals of half-widths (n_rows or 1, n_coordinates) around predictions that err by so
    much. RMSE and MAE are those of `core.metrics.point`, which checks true and predicted positions anew in each of
    thousands of draws, for longer than all else takes.
    """
    bounds = around(np.zeros_like(errors), np.broadcast_to(halves, errors.shape))
    return {
        "rmse_mm": float(np.sqrt(np.square(errors).mean(axis=0)).mean()),
        "mae_mm": float(np.abs(errors).mean(axis=0).mean()),
        "coverage": float(covered(errors, bounds).mean()),
        "mean_width_mm": float(widths(bounds).mean()),
        "winkler_mm": float(winkler_scores(errors, bounds, level).mean()),
    }


def plain(of_part: Part, level: float) -> dict[str, Any]:
    """Split conformal prediction."""
    halves = conformal_limits(np.abs(of_part.known), [level])
    return {"method": PLAIN, "n_recalibration_poses": 0} | scores(of_part.new, halves, level)


def over_time(split: str, subset: str, of_part: Part, level: float) -> Iterator[dict[str, Any]]:
    """Split conformal prediction beside the methods that take rows in turn: on all rows, then by blocks of time."""
    halves = after(np.abs(of_part.known), np.abs(of_part.new), level)
    everything = [(subset, np.arange(len(of_part.new)))]
    yield from _in_parts(split, everything, of_part.new, halves, level)
    parts = [(f"{subset}, {name}", rows) for name, rows in blocks(len(of_part.new))]
    yield from _in_parts(BLOCKS[split], parts, of_part.new, halves, level)


def by_session(samples: Mapping[str, Samples], errors: Mapping[str, Array], level: float) -> Iterator[dict[str, Any]]:
    """The same on the published rows of test in the order of time, among those of `validation`: session by session, and
    by blocks of time.
    """
    known, new = samples[VALIDATION].recording, samples[TEST].recording
    assert known is not None
    assert new is not None
    first, order = np.argsort(known.order, kind="stable"), np.argsort(new.order, kind="stable")
    in_order, session = errors[TEST][order], new.session[order]
    halves = among(np.abs(errors[VALIDATION][first]), known.order[first], np.abs(in_order), new.order[order], level)
    parts = [(f"{TEST}, session {one}", np.flatnonzero(session == one)) for one in np.unique(session)]
    parts += [(f"{TEST}, {name}", rows) for name, rows in blocks(len(order))]
    yield from _in_parts(BLOCKS[PUBLISHED], parts, in_order, halves, level)


def _in_parts(
    split: str, parts: list[tuple[str, Indices]], errors: Array, halves: Mapping[str, Array], level: float
) -> Iterator[dict[str, Any]]:
    """A row for each part of time and method."""
    for subset, rows in parts:
        for method, half in halves.items():
            key = {"split": split, "subset": subset, "method": method, "n_recalibration_poses": 0}
            yield key | scores(errors[rows], np.broadcast_to(half, errors.shape)[rows], level)


def relabelled(subset: str, of_part: Part, level: float, seed: int) -> Iterator[dict[str, Any]]:
    """Recalibration on poses drawn from the new session, and on its first ones; scored on the others."""
    rng = np.random.default_rng(seed)
    key = {"split": NEXT_SESSION, "subset": subset}
    for n_poses in N_POSES:
        drawn = [recalibrated(of_part, rng.permutation(len(of_part.new))[:n_poses], level) for _ in range(N_DRAWS)]
        means = pd.DataFrame(drawn).mean().to_dict()
        yield key | {"method": RECALIBRATED, "n_recalibration_poses": n_poses} | means
    first = {"method": FIRST_POSES, "n_recalibration_poses": N_POSES[1]}
    yield key | first | recalibrated(of_part, np.arange(N_POSES[1]), level)


def recalibrated(of_part: Part, labelled: Indices, level: float) -> dict[str, float]:
    """Scores of the rows that are not labelled."""
    moving = np.ones(of_part.new.shape[1], dtype=bool)
    found = recalibration(of_part.known, of_part.new[labelled], moving, of_part.spread, "recording")
    rest = np.delete(of_part.new, labelled, axis=0) - found.zero
    return scores(rest, found.half_widths(of_part.known, [level])[0], level)
