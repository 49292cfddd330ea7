"""Tune a point model on `train`: a study of each searched preset, over its parameters and the target space.

The preset `tuned`, for commands in-domain, is scored by cross-validation (see `folds_of`); the preset `outer`, for
extrapolation, by outer shells: fitted on the inner core of `train` by command norm, scored on the shell around it, for
cores of several sizes.
"""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from softkin.core.errors import SoftkinError
from softkin.core.files import replacing, write_json
from softkin.core.folds import Folds, folds_of
from softkin.core.runs import OUTER, TUNED
from softkin.core.samples import TRAIN, Params, Samples, informative_coordinates
from softkin.core.shells import command_norm, outer_shells
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.models.target_spaces import TARGET_SPACES
from softkin.training.bounded_space import bounded_space
from softkin.training.kinematic_model import FitSettings, fitted_model
from softkin.training.memory_space import first_memories, memory_space, simplest, taken_memory
from softkin.training.study import Search, StudyFile, TuningResult, TuningSettings, bounded_rows, record, run_study

if TYPE_CHECKING:
    from optuna.trial import Trial

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
class SearchSettings:
    """`n_trials` by preset; the presets whose `scores` best parameters get; moving markers of a trial at most;
    the shares of the rows of `train` that cores hold; the target spaces to choose from.
    """

    n_trials: Mapping[str, int]
    scores: Collection[str]
    max_markers: int
    core_shares: Sequence[float]
    target_spaces: Sequence[str]


def part_errors(
    spec: ModelSpec, params: Params, samples: Samples, parts: Folds, robot: Robot, seed: int, threads: int
) -> Iterator[float]:
    """Mean absolute error (mm) over moving coordinates, part by part.

    Where the target space does not hold a part (no arc leads to a marker) the error is infinite, and the last.

    Parameters:
        spec: the model.
        params: its parameters, and the target space.
        samples: rows of `train`.
        parts: of each part the rows that are fitted on, standardisation included, and those that are scored.
        robot: declares the base.
        seed: seed of the fits.
        threads: threads of a fit at most.
    """
    own_params = dict(params)
    space = own_params.pop(SPACE)
    memory = taken_memory(own_params)
    moving = informative_coordinates(samples.positions)
    for fitted_rows, scored_rows in parts:
        settings = FitSettings(own_params, True, seed, threads, target_space=space, base=robot.base, memory=memory)
        try:
            model = fitted_model(spec, settings, samples.take(fitted_rows))
        except SoftkinError as error:
            logger.info("target space '%s' cannot be fitted on a part: %s", space, error)
            yield float("inf")
            return
        scored = samples.take(scored_rows)
        yield float(np.abs(model.predict(scored.inputs) - scored.positions)[:, moving].mean())


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


def possible_spaces(samples: Samples, spaces: Sequence[str], robot: Robot) -> list[str]:
    """The target spaces that hold every row; the log says why another is left out.

    Raises:
        SoftkinError: there is none; the error of the last one.
    """
    possible = []
    for space in spaces:
        try:
            TARGET_SPACES[space].transformer(True, robot.base).fit(samples.positions, samples.commands)
            possible.append(space)
        except SoftkinError as error:
            logger.warning("target space '%s' is left out: %s", space, error)
            reason = error
    if not possible:
        raise reason
    return possible


@dataclass(frozen=True, slots=True)
class PresetFiles:
    """Files of one preset: its `study` (a journal), the best `parameters` (JSON) and all `trials` (CSV)."""

    study: str | Path
    parameters: str | Path
    trials: str | Path


def tune_model(
    samples: Samples,
    *,
    spec: ModelSpec,
    preset: str,
    robot: Robot,
    settings: TuningSettings,
    search: SearchSettings,
    file: StudyFile,
    threads: int,
) -> tuple[TuningResult, dict[str, float]]:
    """The study of a model by the score of `preset`, and the scores (mm) of its best parameters by name.

    Parameters:
        samples: rows of `train`.
        spec: the model.
        preset: whose score is minimised.
        robot: base and command norm.
        settings: folds, rows and seed of a trial.
        search: number of trials, scores and target spaces.
        file: where the study lives, and the code that decides it.
        threads: threads of a fit at most.
    """
    spaces = possible_spaces(samples, search.target_spaces, robot)
    rows = some_markers(bounded_rows(samples, settings.max_rows, settings.seed), search.max_markers)
    parts = {TUNED: folds_of(rows, settings.n_folds, settings.seed)}
    if OUTER in search.scores:
        norm = command_norm(samples.commands, standardised=robot.standardised_norm)
        parts[OUTER] = outer_shells(norm.of(rows.commands), search.core_shares)

    def errors_of(params: Params, by: str) -> Iterator[float]:
        return part_errors(spec, params, rows, parts[by], robot, settings.seed, threads)

    draw = memory_space(lambda n_features: bounded_space(spec, n_features, parts[preset]), rows)

    def search_space(trial: Trial) -> Params:
        return {SPACE: trial.suggest_categorical(SPACE, spaces), **draw(trial)}

    first = [{SPACE: space, **trial} for space in spaces for trial in spec.first_trials]
    decides = [preset, *spaces, str(robot), str(search.max_markers), *map(str, search.core_shares)]
    result = run_study(
        samples,
        search=Search(
            name=" ".join([spec.name, *decides]),
            space=search_space,
            first_trials=first_memories(first, rows),
            errors_of=lambda params: errors_of(params, preset),
            n_parts=len(parts[preset]),
        ),
        settings=replace(settings, n_trials=search.n_trials[preset]),
        file=file,
    )
    result = simplest(result)
    others = {by: float(np.mean(list(errors_of(result.params, by)))) for by in parts if by != preset}
    return result, {SCORES[by]: score for by, score in {preset: result.score_mm, **others}.items()}


def tune_table(
    table: str | Path,
    *,
    spec: ModelSpec,
    robot: Robot,
    settings: TuningSettings,
    search: SearchSettings,
    files: Mapping[str, PresetFiles],
    code: str,
    threads: int,
) -> None:
    """Tune a model on `train` of `table` by each preset; write the best parameters and all trials.

    Parameters:
        table: path of the tidy table (Parquet).
        spec: the model.
        robot: base and command norm.
        settings: folds, rows and seed of a trial.
        search: number of trials, scores and target spaces.
        files: files of each preset that is searched.
        code: hash of the code that decides the studies.
        threads: threads of a fit at most.
    """
    samples = read_subset(table, TRAIN)
    for preset, of_preset in files.items():
        logger.info("preset %s", preset)
        result, scores = tune_model(
            samples,
            spec=spec,
            preset=preset,
            robot=robot,
            settings=settings,
            search=search,
            file=StudyFile(of_preset.study, code),
            threads=threads,
        )
        with replacing(of_preset.trials) as temporary:
            result.trials.to_csv(temporary, index=False)
        params = dict(result.params)
        finite = {name: score if np.isfinite(score) else None for name, score in scores.items()}
        other = {"other_space": other_space(result)} if preset == OUTER else {}
        found = {SPACE: params.pop(SPACE), "memory": taken_memory(params), "params": params}
        write_json(of_preset.parameters, {**found, **finite, **other, **record(result)})


def other_space(result: TuningResult) -> dict[str, Any] | None:
    """The best trial of a target space other than the best one's: its space, params and score; None without one."""
    for params, score in result.complete:
        if params[SPACE] != result.params[SPACE]:
            own_params = {name: value for name, value in params.items() if name != SPACE}
            memory = taken_memory(own_params)
            return {SPACE: params[SPACE], "memory": memory, "params": own_params, SCORES[OUTER]: score}
    return None
