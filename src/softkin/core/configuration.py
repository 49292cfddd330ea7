"""Check the configuration against its schema and the registries, and list every problem with its likely fix."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from softkin.core.errors import ConfigError


def check_configuration(config: Mapping[str, Any], schema: str | Path, registries: Mapping[str, Iterable[str]]) -> None:
    """Check `config` against the YAML `schema`, and the names in it against the `registries`: `models`, `formats`,
    `interval_methods`, `regions`, `quantile_models` and `standins`.

    Raises:
        ConfigError: lists every problem: the key, what is wrong, and for an unknown name its likely spelling.
    """
    validator = Draft202012Validator(yaml.safe_load(Path(schema).read_text(encoding="utf-8")))
    problems = [line for error in validator.iter_errors(config) for line in _explain(error)]
    if not problems:
        problems = list(_unknown_names(config, registries))
    if problems:
        raise ConfigError(
            "\n  ".join([f"{len(problems)} key{'s' * (len(problems) > 1)} cannot be used", *problems]),
            where="configuration",
            fix="correct each as config/README.md explains it",
        )


def _unknown_names(config: Mapping[str, Any], registries: Mapping[str, Iterable[str]]) -> Iterator[str]:
    """Levels out of order, and names that no registry has."""
    levels = list(config["confidence_levels"])
    if levels != sorted(levels):
        yield f"confidence_levels: {levels} are not ascending; write {sorted(levels)}"
    for key, kind, name, known in _named(config, registries):
        if name not in known:
            yield f"{key}: '{name}' is no {kind} ({', '.join(known)}){_guess(name, list(known))}"


def _named(
    config: Mapping[str, Any], registries: Mapping[str, Iterable[str]]
) -> Iterator[tuple[str, str, str, Iterable[str]]]:
    """(key, kind of thing, name, known names) of each name in the configuration."""
    for key, kind, registry in (
        ("datasets", "entry of config/datasets.yaml", config["sources"]),
        ("models", "model", registries["models"]),
        ("interval_methods", "interval method", registries["interval_methods"]),
        ("max_fit_rows", "model", registries["models"]),
        ("regions", "region", registries["regions"]),
        ("quantile_models", "quantile regressor", registries["quantile_models"]),
    ):
        yield from ((key, kind, name, registry) for name in config[key])
    for dataset, source in config["sources"].items():
        key = f"sources.{dataset}"
        yield f"{key}.format", "format", source["format"], registries["formats"]
        if "standin" in source:
            yield f"{key}.standin.robot", "simulated robot", source["standin"]["robot"], registries["standins"]
        for model in source.get("paper_params", {}):
            yield f"{key}.paper_params", "model", model, registries["models"]


def _explain(error: ValidationError) -> list[str]:
    """One line per problem of a violation of the schema."""
    place = ".".join(map(str, error.absolute_path)) or "top level"
    schema: Any = error.schema
    value: Any = error.validator_value
    instance: Any = error.instance
    if error.validator == "additionalProperties":
        known = list(schema.get("properties", {}))
        unknown = [key for key in instance if key not in known]
        return [f"{place}: unknown key '{key}'{_guess(key, known)}" for key in unknown]
    if error.validator == "enum":
        choices = [str(choice) for choice in value]
        return [f"{place}: {error.instance!r} is none of {', '.join(choices)}{_guess(str(error.instance), choices)}"]
    if error.validator == "required":
        return [f"{place}: {error.message}"]
    description = schema.get("description", "")
    return [f"{place}: {error.message}" + (f" ({description})" if description else "")]


def _guess(word: str, known: list[str]) -> str:
    near = difflib.get_close_matches(word, known, n=1)
    return f"; did you mean '{near[0]}'?" if near else ""
