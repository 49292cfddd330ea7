"""The shipped timings are those of the rules, datasets and models that there are."""

from __future__ import annotations

import csv
import re

import yaml

from softkin.cli.watching.timings import ANY, Timing, Timings
from tests.conftest import HOUSE

FILE = HOUSE / "resources" / "timings.csv"
with FILE.open(encoding="utf-8", newline="") as stream:
    ROWS = [Timing(**row) for row in csv.DictReader(stream)]
CONFIG = yaml.safe_load((HOUSE / "config" / "config.yaml").read_text())
RULES = {
    name
    for path in (HOUSE / "workflow" / "rules").glob("*.smk")
    for name in re.findall(r'^ *rule(?: (?=\w+:)|:\s+name:\s+name_of\(")(\w+)', path.read_text(), re.MULTILINE)
}

#: Its jobs are of datasets whose entry names an orientation; where nothing was timed the view takes the median of all.
NOT_BY_DEFAULT = {"fit_orientation"}


def test_the_view_can_read_them() -> None:
    assert Timings.read(FILE).seconds(ROWS[0].rule, {}) >= 0.0


def test_every_rule_was_timed_and_no_other() -> None:
    """After a change of rules: `make timings`, from a finished run of the default configuration."""
    assert {row.rule for row in ROWS} == RULES - NOT_BY_DEFAULT


def test_rules_that_the_default_configuration_does_without_are_asked_for_by_a_key_of_an_entry() -> None:
    assert NOT_BY_DEFAULT <= RULES
    sources = yaml.safe_load((HOUSE / "config" / "datasets.yaml").read_text())["sources"]
    assert not any("orientation" in sources[name] for name in CONFIG["datasets"])


def test_they_are_of_the_default_configuration() -> None:
    assert {row.dataset for row in ROWS} - {ANY} == set(CONFIG["datasets"])
    models = {row.model.split("/")[0] for row in ROWS} - {ANY}
    assert models == {*CONFIG["models"], *CONFIG["ensembles"], *CONFIG["quantile_models"]}
