from __future__ import annotations

import pytest

from softkin.reporting.titles import Titles

TITLES = Titles({"gp": "Gaussian process"}, {"cqr": "CQR"})


def test_a_run_is_its_models_title_and_its_preset() -> None:
    assert TITLES.run("gp", "tuned") == "Gaussian process, tuned"


def test_a_model_without_a_title_is_an_error() -> None:
    with pytest.raises(KeyError):
        TITLES.run("lr", "tuned")
