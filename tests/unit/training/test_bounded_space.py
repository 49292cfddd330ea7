from __future__ import annotations

import logging

import numpy as np
import pytest
from optuna.trial import FixedTrial

from softkin.core.folds import Folds
from softkin.models import MODELS
from softkin.models.quantile import QUANTILE_MODELS
from softkin.training.bounded_space import bounded_space
from tests.contract.laws import first_params

PARTS: Folds = [(np.arange(n), np.arange(n, 800)) for n in (560, 400, 680)]


def test_the_fewest_rows_of_a_part_bound_every_trial_and_the_log_says_so_once(
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level(logging.WARNING, logger="softkin")
    space = bounded_space(MODELS["lr"], 6, PARTS)
    trials = [FixedTrial({"degree": degree, "interaction_only": False}) for degree in (6, 5, 4)]
    assert [space(trial)["degree"] for trial in trials] == [4, 4, 4]  # type: ignore[arg-type]
    assert caplog.messages == ["trials of 400 rows allow fewer terms of 6 commands: degree is 4"]


@pytest.mark.parametrize("spec", [*MODELS.values(), *QUANTILE_MODELS.values()], ids=lambda spec: spec.title)
def test_parameters_that_the_rows_allow_are_as_drawn(spec: object, caplog: pytest.LogCaptureFixture) -> None:
    for start, params in zip(spec.first_trials, first_params(spec), strict=True):  # type: ignore[attr-defined, arg-type]
        assert bounded_space(spec, 2, PARTS)(FixedTrial(dict(start))) == params  # type: ignore[arg-type]
    assert not caplog.messages


@pytest.mark.parametrize("name", ["gb", "xgb"])
def test_trends_of_many_commands_lose_their_products(name: str, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING, logger="softkin")
    for spec in (MODELS[name], QUANTILE_MODELS[name]):
        space = bounded_space(spec, 64, PARTS)
        (drawn,) = [start for start in spec.first_trials if start["trend"] == "quadratic"]
        params = space(FixedTrial(dict(drawn)))  # type: ignore[arg-type]
        assert (params["trend"], params["interactions"]) == ("quadratic", False)
    assert caplog.messages == ["trials of 400 rows allow fewer terms of 64 commands: interactions is False"] * 2
