"""Tune a point model on `train`: a study of each searched preset, over its parameters and the target space.

The preset `tuned`, for commands in-domain, is scored by cross-validation (see `folds_of`); the preset `outer`, for
extrapolation, by outer shells: fitted on the inner core of `train` by command norm, scored on the shell around it, for
cores of several sizes.
"""

from __future__ import annotations

import logging
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from softkin.core.errors import SoftkinError
from softkin.core.files import replacing, write_json
from softkin.core.runs import OUTER
from softkin.core.samples import TRAIN, Params, Samples
from softkin.data.table import read_subset
from softkin.models.spec import ModelSpec
from softkin.models.target_spaces import TARGET_SPACES
from softkin.training.bounded_space import bounded_space
from softkin.training.held_out import SCORES, SPACE, HeldOut, PartSettings, Robot, parts_of, write_held_out
from softkin.training.memory_space import first_memories, memory_space, simplest, taken_memory
from softkin.training.study import Search, StudyFile, TuningResult, TuningSettings, record, run_study

if TYPE_CHECKING:
    from optuna.trial import Trial

logger = logging.getLogger("softkin")


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
    """Files of one preset: its `study` (a journal), the best `parameters` (JSON), all `trials` (CSV), and what a model
    with the best parameters predicts of rows `held_out` (NPZ).
    """

    study: str | Path
    parameters: str | Path
    trials: str | Path
    held_out: str | Path


def held_out_rows(
    samples: Samples, *, spec: ModelSpec, robot: Robot, settings: TuningSettings, search: SearchSettings, threads: int
) -> HeldOut:
    """What scores the parameters of all studies of a model: what two of them draw is fitted once.

    Parameters:
        samples: rows of `train`.
        spec: the model.
        robot: base and command norm.
        settings: folds, rows and seed of a trial.
        search: scores, markers and cores.
        threads: threads of a fit at most.
    """
    wanted = PartSettings(
        settings.n_folds, search.core_shares, settings.max_rows, search.max_markers, search.scores, settings.seed
    )
    return HeldOut(spec, *parts_of(samples, wanted, robot), robot, settings.seed, threads)


def tune_model(
    samples: Samples,
    *,
    held_out: HeldOut,
    preset: str,
    settings: TuningSettings,
    search: SearchSettings,
    file: StudyFile,
) -> TuningResult:
    """The study of a model by the score of `preset`.

    Parameters:
        samples: rows of `train`.
        held_out: what scores parameters of the model, by `held_out_rows`.
        preset: whose score is minimised.
        settings: folds, rows and seed of a trial.
        search: number of trials, scores and target spaces.
        file: where the study lives, and the code that decides it.
    """
    spec, rows, parts, robot = held_out.spec, held_out.rows, held_out.parts, held_out.robot
    spaces = possible_spaces(samples, search.target_spaces, robot)
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
            errors_of=lambda params: held_out.errors(params, preset),
            n_parts=len(parts[preset]),
        ),
        settings=replace(settings, n_trials=search.n_trials[preset]),
        file=file,
    )
    return simplest(result)


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
    held_out = held_out_rows(samples, spec=spec, robot=robot, settings=settings, search=search, threads=threads)
    for preset, of_preset in files.items():
        logger.info("preset %s", preset)
        result = tune_model(
            samples,
            held_out=held_out,
            preset=preset,
            settings=settings,
            search=search,
            file=StudyFile(of_preset.study, code),
        )
        with replacing(of_preset.trials) as temporary:
            result.trials.to_csv(temporary, index=False)
        write_held_out(held_out, result.params, of_preset.held_out)
        params = dict(result.params)
        scores = {by: held_out.predicted(params, by)[1] for by in sorted(held_out.parts, key=lambda by: by != preset)}
        finite = {SCORES[by]: score if np.isfinite(score) else None for by, score in scores.items()}
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
