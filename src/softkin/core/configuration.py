"""Check the configuration against its schema, and say what is wrong so that a person can mend it."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from softkin.core.errors import SoftkinError


def check_configuration(config: Mapping[str, Any], schema: str | Path, registries: Mapping[str, Iterable[str]]) -> None:
    """Check `config` against the YAML `schema`, and the names in it against the `registries`: of models,
    formats, interval methods, regions, learners of quantiles and simulated robots.

    Raises:
        SoftkinError: lists every problem: the key, what is wrong, and for an unknown key its likely spelling.
    """
    validator = Draft202012Validator(yaml.safe_load(Path(schema).read_text(encoding="utf-8")))
    problems = [line for error in validator.iter_errors(config) for line in _explain(error)]
    if not problems:
        problems = list(_unknown_names(config, registries))
    if problems:
        raise SoftkinError("the configuration cannot be used:\n  " + "\n  ".join(problems) + "\n  see config/README.md")


def _unknown_names(config: Mapping[str, Any], registries: Mapping[str, Iterable[str]]) -> Iterator[str]:
    sources = config["sources"]
    names = [("datasets", "entry of config/datasets.yaml", dataset, sources) for dataset in config["datasets"]]
    names += [("models", "model of the registry", model, registries["models"]) for model in config["models"]]
    names += [
        ("interval_methods", "known method", name, registries["interval_methods"])
        for name in config["interval_methods"]
    ]
    names += [
        ("max_fit_rows", "model of the registry", model, registries["models"]) for model in config["max_fit_rows"]
    ]
    names += [("regions", "known region", name, registries["regions"]) for name in config["regions"]]
    names += [
        ("quantile_models", "known learner", name, registries["quantile_models"]) for name in config["quantile_models"]
    ]
    for dataset, source in sources.items():
        place = f"sources.{dataset}"
        names.append((f"{place}.format", "known format", source["format"], registries["formats"]))
        if "standin" in source:
            names.append(
                (f"{place}.standin.robot", "simulated robot", source["standin"]["robot"], registries["standins"])
            )
        names += [
            (f"{place}.paper_params", "model of the registry", model, registries["models"])
            for model in source.get("paper_params", {})
        ]
    levels = list(config["confidence_levels"])
    if levels != sorted(levels):
        yield f"confidence_levels: {levels} are not ascending; write {sorted(levels)}"
    for place, kind, name, known in names:
        if name not in known:
            yield f"{place}: '{name}' is no {kind} ({', '.join(known)}){_guess(name, list(known))}"


def _explain(error: ValidationError) -> list[str]:
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
