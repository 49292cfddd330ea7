from __future__ import annotations

import pytest
import yaml

from softkin.core.runs import OUTER, PAPER, PAPERS_LEVEL, PRESETS, SEARCHED, TUNED, Run, nearest_level
from tests.conftest import HOUSE


def test_a_run_is_its_model_and_preset() -> None:
    run = Run("svr", TUNED)
    assert run == ("svr", "tuned")
    assert {run: 1}[Run(preset="tuned", model="svr")] == 1
    assert run != Run("svr", PAPER)
    with pytest.raises(AttributeError):
        run.model = "gp"  # type: ignore[misc]


def test_runs_sort_by_model_then_preset() -> None:
    runs = [Run("svr", PAPER), Run("gp", TUNED), Run("gp", OUTER)]
    assert sorted(runs) == [Run("gp", OUTER), Run("gp", TUNED), Run("svr", PAPER)]


def test_every_preset_but_the_papers_has_a_study() -> None:
    assert PRESETS == (PAPER, TUNED, OUTER)
    assert set(SEARCHED) == set(PRESETS) - {PAPER}


def test_the_papers_level_is_calibrated_by_default() -> None:
    assert PAPERS_LEVEL in yaml.safe_load((HOUSE / "config" / "config.yaml").read_text())["confidence_levels"]


def test_methods_are_compared_at_the_level_nearest_to_the_papers() -> None:
    assert nearest_level([0.5, 0.88, 0.95]) == 0.88
    assert nearest_level([0.8, 0.9, 0.95]) == 0.9
