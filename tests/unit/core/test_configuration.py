from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import pytest
import yaml

from softkin.core.configuration import check_configuration
from softkin.core.errors import ConfigError
from softkin.core.schema_files import read_schema
from softkin.data.readers import READERS
from softkin.data.standins import STANDINS
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.models.quantile import QUANTILE_MODELS
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.regions import REGION_METHODS
from tests.conftest import HOUSE

SCHEMA = HOUSE / "workflow" / "schemas" / "config.schema.yaml"
GOOD: dict[str, Any] = {}
for name in ("config", "datasets"):
    GOOD |= yaml.safe_load((HOUSE / "config" / f"{name}.yaml").read_text())


def check(config: dict[str, Any]) -> None:
    registries: dict[str, Any] = {"models": MODELS, "ensembles": ENSEMBLES, "formats": READERS}
    registries |= {"interval_methods": INTERVAL_METHODS, "quantile_models": QUANTILE_MODELS}
    registries |= {"regions": REGION_METHODS, "standins": STANDINS}
    check_configuration(config, SCHEMA, registries)


def test_the_shipped_configuration_is_good() -> None:
    check(GOOD)
    test = yaml.safe_load((HOUSE / "config" / "test.yaml").read_text())
    check(GOOD | {**test, **{key: GOOD[key] | test[key] for key in ("tuning", "refitting")}})


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda c: c["tuning"].update(n_trails=3), ["tuning: unknown key 'n_trails'", "did you mean 'n_trials'?"]),
        (lambda c: c.update(sed=1), ["unknown key 'sed'", "did you mean 'seed'?"]),
        (lambda c: c["tuning"].update(n_trials="many"), ["tuning.n_trials", "total number of trials"]),
        (lambda c: c["tuning"].update(n_folds=1), ["tuning.n_folds", "at least 2"]),
        (lambda c: c["tuning"].pop("n_trials"), ["tuning", "'n_trials' is a required property"]),
        (lambda c: c.update(models=["svm"]), ["models: 'svm' is no model", "did you mean 'svr'?"]),
        (lambda c: c.update(presets=["tunde"]), ["presets.0", "did you mean 'tuned'?"]),
        (lambda c: c.update(datasets=["fingers"]), ["datasets: 'fingers'", "did you mean 'finger'?"]),
        (lambda c: c.update(interval_methods=["scp_mapy"]), ["did you mean 'scp_mapie'?"]),
        (lambda c: c.update(regions=["joint_boxes"]), ["did you mean 'joint_box'?"]),
        (lambda c: c["refitting"].update(n_resamples=3), ["refitting.n_resamples", "at least 10"]),
        (lambda c: c.update(quantile_models=["xbg"]), ["did you mean 'xgb'?"]),
        (lambda c: c.update(confidence_levels=[0.9, 0.8]), ["not ascending", "[0.8, 0.9]"]),
        (lambda c: c.update(confidence_levels=[90]), ["confidence_levels.0", "90"]),
        (lambda c: c["max_fit_rows"].update(gpp=500), ["max_fit_rows: 'gpp'", "did you mean 'gp'?"]),
        (lambda c: c["max_fit_rows"].update(quantile_gp=500), ["max_fit_rows: 'gp' is no quantile regressor"]),
        (lambda c: c.update(when_unreachable="simulat"), ["did you mean 'simulate'?"]),
        (lambda c: c["sources"]["finger"]["standin"].update(robot="tendon_fingr"), ["did you mean 'tendon_finger'?"]),
        (lambda c: c["sources"]["finger"].update(sha256="abc"), ["sources.finger.sha256"]),
        (lambda c: c["sources"]["finger"].update(format="kin_json"), ["did you mean 'kinn_json'?"]),
        (lambda c: c["sources"]["finger"]["rows"].update(tests=3), ["sources.finger.rows", "did you mean 'test'?"]),
        (lambda c: c["sources"]["finger"].update(paper_params={"mpl": {}}), ["did you mean 'mlp'?"]),
    ],
)
def test_a_mistake_is_named_with_its_fix(spoil: Callable[[dict[str, Any]], Any], says: list[str]) -> None:
    config = copy.deepcopy(GOOD)
    spoil(config)
    with pytest.raises(ConfigError) as error:
        check(config)
    for part in says:
        assert part in str(error.value)


OWN: dict[str, Any] = {"title": "Arm", "format": "table_file", "file": "arm.csv", "position_unit": "mm"}
OWN |= {"commands": "u[0-9]+", "positions": ["x", "y"], "split": {"method": "random"}}
ALL_FOUR = {"train": 0, "validation": 1, "test": 2, "extrapolation": 3}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"dimensions": 2, "delimiter": " ", "n_commands": 64, "n_markers": 1, "sha256": "0" * 64},
        {"split": {"method": "column", "column": "part", "names": ALL_FOUR}},
        {"split": {"method": "group", "column": "trial", "seed": 1, "extrapolation_share": 0.2}},
        {"split": {"method": "time", "column": "t", "blocks": 20}},
        {"urls": ["https://example.org/arm.csv"], "sha256": "0" * 64, "licence": "CC0", "citation": "nobody"},
        {"notes": {"test": "hm"}, "paper_params": {"mlp": {"max_iter": 9}}, "rows": dict.fromkeys(ALL_FOUR, 5)},
    ],
)
def test_a_robot_of_ones_own_is_one_entry(changes: dict[str, Any]) -> None:
    check(GOOD | {"datasets": ["arm"], "sources": GOOD["sources"] | {"arm": OWN | changes}})


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"commands": None}, ["sources.arm: 'commands' is a required property"]),
        ({"split": None}, ["sources.arm: 'split' is a required property"]),
        ({"commands": []}, ["sources.arm.commands", "a list of names, or a pattern"]),
        ({"positions": ["x", "x"]}, ["sources.arm.positions"]),
        ({"dimensions": 4}, ["sources.arm.dimensions: 4 is none of 2, 3"]),
        ({"delimiter": "a"}, ["sources.arm.delimiter", "splits columns"]),
        ({"dimension": 2}, ["did you mean 'dimensions'?"]),
        ({"urls": ["https://example.org/arm.csv"]}, ["'sha256' is a dependency of 'urls'"]),
        ({"split": {"method": "groups"}}, ["sources.arm.split.method", "did you mean 'group'?"]),
        ({"split": {"method": "group"}}, ["sources.arm.split: 'column' is a required property"]),
        (
            {"split": {"method": "random", "blocks": 20}},
            ["sources.arm.split: 'blocks' is none of method, extrapolation"],
        ),
        ({"split": {"method": "random", "sed": 2}}, ["sources.arm.split: unknown key 'sed'", "did you mean 'seed'?"]),
        ({"split": {"method": "random", "extrapolation_share": 1.5}}, ["extrapolation_share", "share of rows"]),
        ({"split": {"method": "column", "column": "c", "names": {"train": 0}}}, ["'test' is a required property"]),
        ({"format": "table_fil"}, ["did you mean 'table_file'?"]),
    ],
)
def test_a_mistake_in_a_robot_of_ones_own_is_named(changes: dict[str, Any], says: list[str]) -> None:
    entry = {key: value for key, value in (OWN | changes).items() if value is not None}
    with pytest.raises(ConfigError) as error:
        check(GOOD | {"sources": GOOD["sources"] | {"arm": entry}})
    for part in says:
        assert part in str(error.value)


def test_keys_of_a_table_do_not_belong_to_a_published_dataset() -> None:
    config = copy.deepcopy(GOOD)
    config["sources"]["finger"]["split"] = {"method": "random"}
    with pytest.raises(ConfigError, match=r"sources\.finger: 'split' .*belongs to format table_file"):
        check(config)


def test_all_mistakes_are_listed_at_once() -> None:
    config = copy.deepcopy(GOOD)
    config["sed"], config["tuning"]["n_trails"] = 1, 2
    with pytest.raises(ConfigError, match=r"(?s)n_trails.*sed|sed.*n_trails"):
        check(config)


def test_of_what_a_dataset_gets_alone_something_is_configured() -> None:
    entry = GOOD["sources"]["elastica_2023_09"]
    own = {"models": ["gp"], "presets": ["tuned"], "quantile_models": ["gb"], "interval_methods": ["scp_mapie"]}
    check(GOOD | {"datasets": ["elastica_2023_09"], "sources": {"elastica_2023_09": entry | own}})
    for key, names in own.items():
        with pytest.raises(ConfigError, match=rf"sources\.elastica_2023_09\.{key}: \[\]"):
            check(GOOD | {"datasets": ["elastica_2023_09"], "sources": {"elastica_2023_09": entry | {key: []}}})
        rest = [name for name in GOOD[key] if name not in names]
        with pytest.raises(
            ConfigError, match=rf"sources\.elastica_2023_09\.{key}: of {names[0]} none is among the configured"
        ):
            check(GOOD | {key: rest, "datasets": ["elastica_2023_09"], "sources": {"elastica_2023_09": entry | own}})


def test_the_schema_is_strict_and_described_throughout() -> None:
    def walk(node: Any, path: str) -> None:
        if not isinstance(node, dict):
            return
        if node.get("type") == "object" and "properties" in node:
            assert node.get("additionalProperties") in (False, None) or isinstance(node["additionalProperties"], dict)
            assert "additionalProperties" in node, path
            for key, value in node["properties"].items():
                assert value.get("description"), f"{path}.{key} has no description"
        for key, value in node.items():
            walk(value, f"{path}.{key}")

    walk(read_schema(SCHEMA), "schema")
