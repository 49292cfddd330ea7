"""Rows of `train` that studies score a model on, by cross-validation and by outer shells; what it predicts of them."""

from __future__ import annotations

import json
import logging
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from softkin.core.errors import SoftkinError
from softkin.core.files import replacing
from softkin.core.folds import Folds, folds_of
from softkin.core.rows import sampled_rows
from softkin.core.runs import OUTER, TUNED
from softkin.core.samples import Array, Params, Samples, informative_coordinates
from softkin.core.shells import command_norm, outer_shells
from softkin.models.spec import ModelSpec
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.memory_space import taken_memory

logger = logging.getLogger("softkin")

#: Name of a preset's score.
SCORES = {TUNED: "cv_mae_mm", OUTER: "shell_mae_mm"}
SPACE = "target_space"


@dataclass(frozen=True, slots=True)
class Robot:
    """What a study needs of a dataset's entry: the `base` that it declares, and whether its command norm is that of
    standardised commands.
    """

    base: Mapping[str, Any] | None
    standardised_norm: bool


@dataclass(frozen=True, slots=True)
class PartSettings:
    """Which rows of `train` a study scores a model on: `n_folds` folds and cores of these `core_shares` of at most
    `max_rows` rows, drawn with the `seed`, and `max_markers` moving markers; `scores` are the presets whose parts are
    needed.
    """

    n_folds: int
    core_shares: Sequence[float]
    max_rows: int
    max_markers: int
    scores: Collection[str]
    seed: int


def parts_of(samples: Samples, settings: PartSettings, robot: Robot) -> tuple[Samples, dict[str, Folds]]:
    """Some rows and markers of `train`, and by preset the parts of them: of each the rows that are fitted on, and those
    that are scored. Every study of a dataset gets the same.
    """
    drawn = samples.take(sampled_rows(len(samples), settings.max_rows, settings.seed))
    rows = some_markers(drawn, settings.max_markers)
    parts = {TUNED: folds_of(rows, settings.n_folds, settings.seed)}
    if OUTER in settings.scores:
        norm = command_norm(samples.commands, standardised=robot.standardised_norm)
        parts[OUTER] = outer_shells(norm.of(rows.commands), settings.core_shares)
    return rows, parts


def some_markers(samples: Samples, max_markers: int) -> Samples:
    """Samples with all markers that never move and at most `max_markers` of the others, evenly spread up to the last.

    Markers of one robot resemble each other, and some models cost a fit per coordinate.
    """
    moves = np.asarray(informative_coordinates(samples.positions).reshape(-1, 3).any(axis=1))
    moving = np.flatnonzero(moves)
    if len(moving) <= max_markers:
        return samples
    # Counted from the end, so that the last marker is always drawn.
    drawn = moving[::-1][np.linspace(0, len(moving), max_markers, endpoint=False).astype(int)]
    kept = np.repeat(~moves | np.isin(np.arange(len(moves)), drawn), 3)
    return replace(samples, positions=samples.positions[:, kept])


@dataclass(frozen=True, slots=True)
class HeldOut:
    """Scores parameters of a model on `parts` of `rows`, by preset, and keeps what was predicted on the way: the best
    parameters of a study need no further fit.

    `threads` of a fit at most; fits are seeded by `seed`.
    """

    spec: ModelSpec
    rows: Samples
    parts: Mapping[str, Folds]
    robot: Robot
    seed: int
    threads: int
    _kept: dict[tuple[str, str], tuple[Array | None, float]] = field(default_factory=dict)
    _predicted_parts: dict[tuple[str, str], list[Array]] = field(default_factory=dict)

    def errors(self, params: Params, by: str) -> Iterator[float]:
        """Mean absolute error (mm) over moving coordinates, part by part of the preset `by`; standardisation, too, is
        by the rows that are fitted on. Bounds may make the same of different draws: it is fitted once.

        Where the target space does not hold a part (no arc leads to a marker) the error is infinite, and the last.
        """
        own_params = dict(params)
        predictions = self._predicted_parts.setdefault((by, _key(params)), [])
        errors: list[float] = []
        space, memory = own_params.pop(SPACE), taken_memory(own_params)
        settings = FitSettings(
            own_params, True, self.seed, self.threads, target_space=space, base=self.robot.base, memory=memory
        )
        truths = truth_of(self.rows, self.parts[by])
        for place, ((fitted_rows, scored_rows), truth) in enumerate(zip(self.parts[by], truths, strict=True)):
            if place < len(predictions):
                errors.append(mean_error(predictions[place], truth))
                yield errors[-1]
                continue
            try:
                model = fitted_model(self.spec, settings, self.rows.take(fitted_rows))
            except SoftkinError as error:
                logger.info("target space '%s' cannot be fitted on a part: %s", space, error)
                self._kept[by, _key(params)] = None, float("inf")
                yield float("inf")
                return
            predictions.append(_of_moving(self.rows, model.predict(self.rows.take(scored_rows).inputs)))
            errors.append(mean_error(predictions[-1], truth))
            yield errors[-1]
        self._kept[by, _key(params)] = np.concatenate(predictions), float(np.mean(errors))

    def predicted(self, params: Params, by: str) -> tuple[Array | None, float]:
        """Predictions (n_scored, n_moving) in mm of the scored rows, part by part, and the mean of the errors on all
        parts; None where that is infinite.
        """
        key = by, _key(params)
        if key not in self._kept:
            for _ in self.errors(params, by):
                pass
        return self._kept[key]


def truth_of(rows: Samples, parts: Folds) -> list[Array]:
    """True positions (n_scored, n_moving) in mm of the scored rows of each part."""
    return [_of_moving(rows, rows.positions[scored]) for _, scored in parts]


def mean_error(predicted: Array, truth: Array) -> float:
    """Mean absolute error (mm)."""
    return float(np.abs(predicted - truth).mean())


def _of_moving(rows: Samples, positions: Any) -> Array:
    """The moving coordinates of positions; the order in memory decides the last bit of a mean."""
    return np.ascontiguousarray(np.asarray(positions)[:, informative_coordinates(rows.positions)])


def write_held_out(held_out: HeldOut, params: Params, path: str | Path) -> None:
    """Write the predictions of the scored rows, an array for each preset that has them."""
    found = {by: held_out.predicted(params, by)[0] for by in held_out.parts}
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, **{by: array for by, array in found.items() if array is not None})  # type: ignore[arg-type]


def read_held_out(path: str | Path) -> dict[str, Array]:
    """Preset -> predictions (n_scored, n_moving) in mm of the scored rows, part by part."""
    with np.load(path) as stored:
        return dict(stored)


def _key(params: Params) -> str:
    return json.dumps(params, sort_keys=True)
