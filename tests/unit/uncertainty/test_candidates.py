from __future__ import annotations

import pytest

from softkin.models import MODELS
from softkin.uncertainty.candidates import problems_of_methods
from softkin.uncertainty.intervals import INTERVAL_METHODS

WITH_SPREAD = [name for name, spec in MODELS.items() if spec.spread is not None]
WITHOUT = next(name for name, spec in MODELS.items() if spec.spread is None)


def problems(methods: list[str], models: list[str], presets: tuple[str, ...] = ("paper", "tuned", "outer")) -> int:
    config = {"interval_methods": methods, "models": models, "ensembles": [], "presets": presets}
    return len(list(problems_of_methods(config, INTERVAL_METHODS, MODELS)))


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
