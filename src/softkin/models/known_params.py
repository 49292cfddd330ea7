"""The parameters that a model's paper preset can have: names and kinds of value, read off the model itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from softkin.models.spec import ModelSpec

#: Turns at the choices of a search space: no categorical parameter has more choices.
_TURNS = 8
#: A seed may be 0; all other numbers are sizes, counts or strengths.
_MAY_BE_ZERO = "random_state"


class _Asked:
    """Stands in for a trial: takes down what a search space asks for."""

    def __init__(self, turn: int) -> None:
        self.turn = turn
        self.known: dict[str, list[Any]] = {}

    def suggest_categorical(self, name: str, choices: Sequence[Any]) -> Any:
        self.known[name] = list(choices)
        return choices[self.turn % len(choices)]

    def suggest_int(self, name: str, low: int, high: int, **_: Any) -> int:
        self.known[name] = [low, high]
        return low

    def suggest_float(self, name: str, low: float, high: float, **_: Any) -> float:
        self.known[name] = [float(low), float(high)]
        return float(low)


def known_params(spec: ModelSpec) -> dict[str, list[Any]]:
    """Parameter -> values that the paper's setting and the search of a model give it, at least one."""
    known: dict[str, list[Any]] = {}
    settings: list[Mapping[str, Any]] = [spec.paper_params, *spec.first_trials]
    for turn in range(_TURNS):
        asked = _Asked(turn)
        settings.append(spec.search_space(asked))  # type: ignore[arg-type]
        for name, values in asked.known.items():
            known.setdefault(name, []).extend(values)
    for setting in settings:
        for name, value in setting.items():
            known.setdefault(name, []).append(value)
    return known


def problems_of_paper_params(config: Mapping[str, Any], models: Mapping[str, ModelSpec]) -> Iterator[str]:
    """Why a model cannot be built with the `paper_params` of an entry: unknown names, and values of another kind."""
    for dataset, entry in config["sources"].items():
        for model, params in entry.get("paper_params", {}).items():
            known = known_params(models[model])
            for name, value in params.items():
                reason = _reason(name, value, known[name]) if name in known else "is no parameter of the model"
                if reason:
                    names = f" ({', '.join(sorted(known))})" if name not in known else f", not {value!r}"
                    yield f"sources.{dataset}.paper_params.{model}: '{name}' {reason}{names}"


def _reason(name: str, value: Any, examples: Sequence[Any]) -> str:
    """Why a value is unlike its examples; empty where it is like them."""
    numbers = [example for example in examples if isinstance(example, (int, float)) and not isinstance(example, bool)]
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if is_number and numbers:
        if all(isinstance(example, int) for example in numbers) and not isinstance(value, int):
            return "must be a whole number"
        least = min([0 if name == _MAY_BE_ZERO else 1e-300, *numbers])
        return "" if value >= least else "must be positive" if name != _MAY_BE_ZERO else "must be at least 0"
    if any(value == example and type(value) is type(example) for example in examples):
        return ""
    others = list(dict.fromkeys(str(example) for example in examples if example not in numbers))
    return f"must be {' or '.join([*(['a number'] if numbers else []), *others])}"
