from __future__ import annotations

from typing import Any

import pytest

from softkin.models import MODELS
from softkin.models.known_params import known_params, problems_of_paper_params


def problems(model: str, **params: Any) -> list[str]:
    return list(problems_of_paper_params({"sources": {"arm": {"paper_params": {model: params}}}}, MODELS))


@pytest.mark.parametrize("model", MODELS)
def test_a_models_own_settings_are_known(model: str) -> None:
    assert problems(model, **MODELS[model].paper_params) == []
    for trial in MODELS[model].first_trials:
        assert problems(model, **trial) == []


def test_both_sides_of_a_choice_are_known() -> None:
    known = known_params(MODELS["mlp"])
    assert {"networks", "learning_rate_init"} <= set(known)
    assert {"tanh", "relu", "logistic"} <= set(known["activation"])


@pytest.mark.parametrize(
    ("params", "says"),
    [
        ({"max_itr": 3}, "is no parameter of the model"),
        ({"max_iter": 3.5}, "must be a whole number"),
        ({"max_iter": True}, "must be a number"),
        ({"max_iter": 0}, "must be positive"),
        ({"random_state": -1}, "must be at least 0"),
        ({"activation": "tan"}, "must be tanh or relu or logistic"),
        ({"alpha": "big"}, "must be a number"),
    ],
)
def test_what_the_model_could_not_be_built_with_is_told(params: dict[str, Any], says: str) -> None:
    (problem,) = problems("mlp", **params)
    assert problem.startswith("sources.arm.paper_params.mlp: ")
    assert says in problem


def test_a_seed_of_zero_is_a_seed() -> None:
    assert problems("mlp", random_state=0, alpha=1, max_iter=1) == []
