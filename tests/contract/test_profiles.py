"""What profiles say of rules holds for the rules that are made for a dataset whose entry narrows what is fitted."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from softkin.core.narrowing import groups, name_of
from tests.conftest import HOUSE

PROFILES = sorted((HOUSE / "profiles").glob("*/config.yaml"))
CONFIG = {
    **yaml.safe_load((HOUSE / "config" / "config.yaml").read_text()),
    **yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text()),
}
#: The rules that are made for each group of datasets and may be one job with others, see workflow/rules/groups.smk.
TOGETHER = ("fit_ensemble", "refit", "calibrate")


@pytest.mark.parametrize("path", PROFILES, ids=lambda path: path.parent.name)
def test_jobs_of_narrowed_datasets_go_together_as_those_of_others(path: Path) -> None:
    together = yaml.safe_load(path.read_text()).get("groups", {})
    named = {name_of(rule, group) for rule in TOGETHER for group in groups(CONFIG)} if together else set()
    assert {name: together.get(name) for name in named} == dict.fromkeys(named, together.get("score"))


def test_some_profile_puts_jobs_together() -> None:
    assert any("groups" in yaml.safe_load(path.read_text()) for path in PROFILES)
