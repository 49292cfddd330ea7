"""What a study of a recording searches besides a model's own parameters: what the model is told of earlier commands.

A study of rows without an order knows nothing of it: its draws are the same with and without this module.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

from softkin.core.samples import Params, Samples
from softkin.models.estimators.memory_features import MEMORIES, NONE, PLAY, PREVIOUS, WIDTH_SETS, n_features
from softkin.training.study import TuningResult

if TYPE_CHECKING:
    from optuna.trial import Trial

MEMORY, WIDTHS = "memory", "widths"
#: Share of the best score by which a memory must beat a simpler one to be chosen: less may be chance.
WORTH_IT = 0.02


def drawn_memory(trial: Trial) -> Params:
    """What a trial tells the model; sessions have zeros in any case."""
    memory = trial.suggest_categorical(MEMORY, MEMORIES)
    return {MEMORY: memory, **({WIDTHS: trial.suggest_categorical(WIDTHS, [*WIDTH_SETS])} if memory == PLAY else {})}


def memory_space(space_of: Callable[[int], Callable[[Trial], Params]], rows: Samples) -> Callable[[Trial], Params]:
    """Draws the parameters of a trial; of a recording, what it tells the model, too. `space_of` makes of a number of
    features the function that draws a model's own parameters.
    """
    n_commands, space_for = rows.commands.shape[1], cache(space_of)
    if rows.recording is None:
        return space_for(n_commands)

    def draw(trial: Trial) -> Params:
        memory = drawn_memory(trial)
        return {**memory, **space_for(n_features(n_commands, **memory))(trial)}

    return draw


def first_memories(first: Sequence[Mapping[str, Any]], rows: Samples) -> Sequence[Mapping[str, Any]]:
    """The `first` trials of a study; of a recording, each with play operators, and among them, before pruning begins,
    the first one with each simpler memory.
    """
    if rows.recording is None:
        return first
    played = [{**trial, MEMORY: PLAY, WIDTHS: "fine"} for trial in first]
    simpler = [{**first[0], MEMORY: memory} for memory in (NONE, PREVIOUS)]
    return [*played[:2], *simpler, *played[2:]]


def taken_memory(params: Params) -> dict[str, Any] | None:
    """Remove from the parameters of a trial what it tells the model, and return it as `FitSettings.memory` has it."""
    if MEMORY not in params:
        return None
    widths = {WIDTHS: params.pop(WIDTHS)} if WIDTHS in params else {}
    return {MEMORY: params.pop(MEMORY), **widths, "zeros": True}


def simplest(result: TuningResult) -> TuningResult:
    """The result with the best of the trials of the simplest memory that costs at most `WORTH_IT` of the best score."""
    good = [(params, score) for params, score in result.complete if score <= (1 + WORTH_IT) * result.score_mm]
    params, score = min(good, key=lambda trial: MEMORIES.index(trial[0].get(MEMORY, NONE)))
    return replace(result, params=params, score_mm=score)
