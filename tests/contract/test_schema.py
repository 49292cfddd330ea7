"""The schema of the configuration and the registries name the same entries, and every key is explained."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator
from typing import Any

import pytest
import yaml

from softkin.cli.configuration import REGISTRIES
from softkin.core.configuration import check_configuration
from softkin.core.errors import ConfigError
from softkin.core.rotations import KINDS
from softkin.core.runs import PRESETS
from softkin.core.schema_files import read_schema
from softkin.data.readers import READERS
from softkin.data.readers.complete_rows import MISSING
from softkin.data.readers.joined_tables import JOINS
from softkin.data.readers.partner_rows import RESAMPLING
from softkin.data.split import GROUPS
from softkin.data.split_in_time import IN_TIME
from softkin.models.target_spaces import TARGET_SPACES
from softkin.training.selection import OBJECTIVES
from softkin.uncertainty.intervals.spec import REGIMES
from tests.conftest import HOUSE

PATH = HOUSE / "workflow" / "schemas" / "config.schema.yaml"
SCHEMA = read_schema(PATH)
#: Each key whose values the schema lists: what the code knows of them.
LISTED = {
    "presets": PRESETS,
    "target_spaces": TARGET_SPACES,
    "objective": OBJECTIVES,
    "regime": REGIMES,
    "promote": ("auto", "manual"),
    "when_unreachable": ("simulate", "fail"),
    "dimensions": (2, 3),
    "missing": MISSING,
    "by": JOINS,
    "resample": RESAMPLING,
    "kind": KINDS,
    "method": ("column", *GROUPS, *IN_TIME),
}
#: What is given with `--configfile`, on top of the default configuration.
MORE = sorted(path for path in (HOUSE / "config").glob("*.yaml") if path.name not in ("config.yaml", "datasets.yaml"))
MISSPELT: dict[str, dict[str, Any]] = {
    "models": {"models": ["lrr"]},
    "ensembles": {"ensembles": ["ensembl"]},
    "max_fit_rows": {"max_fit_rows": {"gpp": 200}},
    "quantile_models": {"quantile_models": ["gbb"]},
    "interval_methods": {"interval_methods": ["scp"]},
    "regions": {"regions": ["joint_boxes"]},
    "target_spaces": {"target_spaces": ["curved"]},
    "presets": {"presets": ["papers"]},
    "objective": {"objective": "extrapolate"},
    "regime": {"regime": "automatic"},
    "datasets": {"datasets": ["fingers"]},
    "sources.finger.format": {"sources": {"finger": {"format": "knn_json"}}},
    "sources.finger.standin.robot": {"sources": {"finger": {"standin": {"robot": "finger", "seed": 1}}}},
    "sources.finger.models": {"sources": {"finger": {"models": ["gpp"]}}},
    "sources.finger.quantile_models": {"sources": {"finger": {"quantile_models": ["gbb"]}}},
    "sources.finger.interval_methods": {"sources": {"finger": {"interval_methods": ["scp"]}}},
    "sources.finger.presets": {"sources": {"finger": {"presets": ["papers"]}}},
    "sources.finger.paper_params": {"sources": {"finger": {"paper_params": {"lrr": {}}}}},
}


def enums(node: Any, key: str = "") -> Iterator[tuple[str, list[Any]]]:
    """(key, values) of each list of values that a key may have."""
    if isinstance(node, dict):
        if "enum" in node:
            yield key, node["enum"]
        for name, value in node.get("properties", {}).items():
            yield from enums(value, name)
        for name in ("items", "additionalProperties"):
            yield from enums(node.get(name), key)


def configuration() -> dict[str, Any]:
    texts = [(HOUSE / "config" / name).read_text() for name in ("config.yaml", "datasets.yaml")]
    return {key: value for text in texts for key, value in yaml.safe_load(text).items()}


def test_values_that_the_schema_lists_are_those_of_the_code() -> None:
    listed = dict(enums(SCHEMA))
    assert {key: set(values) for key, values in listed.items()} == {key: set(LISTED[key]) for key in LISTED}


def test_formats_that_the_schema_tells_apart_are_registered() -> None:
    entry = SCHEMA["properties"]["sources"]["additionalProperties"]
    assert {
        rule["if"]["properties"]["format"]["const"] for rule in entry["allOf"] if "properties" in rule["if"]
    } <= set(READERS)
    methods = {rule["if"]["properties"]["method"]["const"] for rule in entry["properties"]["split"]["allOf"]}
    assert methods == set(LISTED["method"])


def test_snakemake_checks_the_configuration_with_every_registry() -> None:
    text = (HOUSE / "workflow" / "rules" / "configuration.smk").read_text()
    assert "from softkin.cli.configuration import check\n" in text


def test_the_configuration_is_accepted() -> None:
    check_configuration(configuration(), PATH, REGISTRIES)


@pytest.mark.parametrize("name", [path.name for path in MORE])
def test_other_configurations_are_accepted_and_say_what_they_are(name: str) -> None:
    more = yaml.safe_load((HOUSE / "config" / name).read_text())
    config = merged(configuration(), more)
    check_configuration(config, PATH, REGISTRIES)
    assert config["campaign"] != configuration()["campaign"]
    assert config["caution"]


def test_the_demonstration_makes_all_that_a_run_makes_in_a_folder_of_its_own() -> None:
    config = merged(configuration(), yaml.safe_load((HOUSE / "config" / "demo.yaml").read_text()))
    assert config["presets"] == list(PRESETS)
    assert config["regime"] == "auto"
    assert "auto" in config["interval_methods"]
    assert config["tracking_uri"] == "sqlite:///mlflow.db"
    recipe = re.search(r"^demo:.*\n((?:\t.*\n)+)", (HOUSE / "Makefile").read_text(), re.MULTILINE)
    assert recipe
    assert "--directory results/demo --configfile config/demo.yaml" in recipe[1]


@pytest.mark.parametrize("key", MISSPELT)
def test_a_name_that_no_registry_has_is_refused_at_its_key(key: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(key)):
        check_configuration(merged(configuration(), MISSPELT[key]), PATH, REGISTRIES)


def merged(config: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    result = copy.deepcopy(config)
    for key, value in other.items():
        nested = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = merged(result[key], value) if nested else value
    return result


def test_files_that_the_schema_names_are_there() -> None:
    paths = re.findall(r"\bsrc/softkin/[\w/.]+\.py", PATH.read_text())
    assert len(set(paths)) >= 5
    assert [path for path in paths if not (HOUSE / path).is_file()] == []


def test_every_key_of_the_configuration_is_explained() -> None:
    text = (HOUSE / "config" / "README.md").read_text()
    entry = SCHEMA["properties"]["sources"]["additionalProperties"]["properties"]
    nested = [SCHEMA["properties"][key]["properties"] for key in ("tuning", "refitting", "shells", "verdict")]
    for key in [*SCHEMA["properties"], *(key for keys in nested for key in keys), *entry]:
        assert f"`{key}`" in text, f"config/README.md does not explain `{key}`"
