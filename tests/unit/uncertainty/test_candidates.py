from __future__ import annotations

from typing import Any

import pytest

from softkin.models import MODELS
from softkin.uncertainty.candidates import problems_of_methods
from softkin.uncertainty.intervals import INTERVAL_METHODS

WITH_SPREAD = [name for name, spec in MODELS.items() if spec.spread is not None]
WITHOUT = next(name for name, spec in MODELS.items() if spec.spread is None)


def told(methods: list[str], models: list[str], presets: tuple[str, ...], own: dict[str, list[str]]) -> list[str]:
    config: dict[str, Any] = {"interval_methods": methods, "models": models, "ensembles": [], "presets": presets}
    config |= {"quantile_models": ["gb"], "datasets": ["all", "arm"], "sources": {"all": {}, "arm": own}}
    return list(problems_of_methods(config, INTERVAL_METHODS, MODELS))


def problems(methods: list[str], models: list[str], presets: tuple[str, ...] = ("paper", "tuned", "outer")) -> int:
    return len(told(methods, models, presets, {}))


@pytest.mark.parametrize("method", ["scp_mapie", "scp_crepes", "scp_distance", "cps"])
def test_one_calibrated_method_around_every_model_is_enough(method: str) -> None:
    assert problems([method], [WITHOUT, *WITH_SPREAD]) == 0


@pytest.mark.parametrize("method", ["qr", "cqr", "gaussian", "cv_plus", "jackknife_plus_ab", "shell", "auto"])
def test_others_cannot_be_deployed_alone(method: str) -> None:
    assert problems([method], WITH_SPREAD) == 1


def test_a_spread_is_needed_of_every_model_that_may_be_deployed() -> None:
    assert problems(["scp_spread"], WITH_SPREAD) == 0
    assert problems(["scp_spread"], [*WITH_SPREAD, WITHOUT]) == 1


def test_held_out_errors_are_those_of_studies() -> None:
    assert problems(["scp_held_out"], [WITHOUT], ("tuned",)) == 0
    assert problems(["scp_held_out"], [WITHOUT], ("paper",)) == 1


def test_quantiles_need_a_preset_that_has_them() -> None:
    assert problems(["cqr", "scp_mapie"], [WITHOUT], ("outer",)) == 1
    assert problems(["cqr", "scp_mapie"], [WITHOUT], ("tuned",)) == 0


def test_what_the_entry_of_a_dataset_narrows_is_checked_by_itself() -> None:
    methods, models = ["cqr", "scp_mapie", "scp_spread"], [WITHOUT, *WITH_SPREAD]
    assert told(methods, models, ("paper", "outer"), {"models": WITH_SPREAD, "interval_methods": ["scp_spread"]}) == []
    (bare,) = told(methods, models, ("paper", "outer"), {"interval_methods": ["scp_spread"]})
    assert bare.startswith("sources.arm.interval_methods: of scp_spread none is calibrated around every model")
    (unfit,) = told(methods, models, ("paper", "outer"), {"presets": ["outer"]})
    assert unfit.startswith("sources.arm.interval_methods: cqr need quantile regressors, which have no preset outer")
